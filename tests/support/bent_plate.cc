#include "support/bent_plate.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/deformation/graph_file.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/render/rasterizer.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr double kHalfWidth = 0.2;
constexpr double kHalfHeight = 0.15;
constexpr double kNodeSpacing = 0.025;

/// Rows x columns grid of vertices, row by row; triangles that face -z.
TriangleMesh Grid(int columns, int rows, double x0, double y0, double step,
                  double z) {
  TriangleMesh mesh;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.vertices.push_back(
          Eigen::Vector3d(x0 + i * step, y0 + j * step, z).cast<float>());
      if (i == 0 || j == 0) continue;
      const int here = j * columns + i;
      const int above = here - columns;
      mesh.triangles.emplace_back(above - 1, here - 1, above);
      mesh.triangles.emplace_back(above, here - 1, here);
    }
  }
  return mesh;
}

TriangleMesh Moved(TriangleMesh mesh, const Rigid3d& motion) {
  for (Eigen::Vector3f& v : mesh.vertices) v = motion.cast<float>() * v;
  return mesh;
}

/// Nodes on a grid; the neighbours of a node are those around it.
DeformationGraph PlateGraph() {
  DeformationGraph graph;
  graph.node_spacing = kNodeSpacing;
  const int columns = 17;
  const int rows = 13;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      graph.positions.emplace_back(-kHalfWidth + i * kNodeSpacing,
                                   -kHalfHeight + j * kNodeSpacing, 1);
      graph.neighbors.emplace_back();
      for (int v = std::max(j - 1, 0); v <= std::min(j + 1, rows - 1); ++v) {
        for (int u = std::max(i - 1, 0); u <= std::min(i + 1, columns - 1);
             ++u) {
          if (u != i || v != j) {
            graph.neighbors.back().push_back(v * columns + u);
          }
        }
      }
    }
  }
  graph.motions.resize(graph.positions.size());
  return graph;
}

NodeMotion PlateMotion(const BentPlate& plate, const Eigen::Vector3d& g,
                       int frame) {
  const Rigid3d camera_from_world = plate.WorldFromCamera(frame).inverse();
  const double angle = plate.curvature_step * frame * g.x();
  NodeMotion motion;
  motion.rotation =
      camera_from_world.linear() * ExpSo3(Eigen::Vector3d(0, -angle, 0));
  motion.translation =
      camera_from_world * plate.PointAt(g.x(), g.y(), frame) - g;
  return motion;
}

void WriteSurface(const fs::path& folder, const TriangleMesh& mesh,
                  const DeformationGraph& graph, const MotionHistory& history) {
  fs::create_directories(folder);
  WritePly((folder / "mesh.ply").string(), mesh);
  WriteGraph((folder / "graph.json").string(), graph, 6);
  WriteMotions((folder / "motions.bin").string(), history, graph.size());
  // What an OpenVDB file begins with: nothing here looks further.
  std::ofstream(folder / "tsdf.vdb") << std::string(" BDV\0\0\0\0", 8);
}

/// The wall in the true world with `seen` (10) and `label` (0).
void WriteStaticMesh(const fs::path& path, const TriangleMesh& mesh) {
  std::ofstream out(path);
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\n"
         "property uchar seen\nproperty uchar label\nelement face "
      << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3f& v : mesh.vertices) {
    out << v.transpose() << " 10 0\n";
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    out << "3 " << t.transpose() << '\n';
  }
}

template <typename T>
void WriteBinary(std::ostream& out, const T& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof(T));
}

void WriteTracks(const fs::path& path, const BentPlate& plate) {
  const int points = 25;
  std::ofstream out(path, std::ios::binary);
  for (const std::uint32_t value :
       {0x4b525431u, 1u, static_cast<std::uint32_t>(plate.frames),
        static_cast<std::uint32_t>(points)}) {
    WriteBinary(out, value);
  }
  for (int i = 0; i < points; ++i) {
    WriteBinary(out, std::int32_t{1});
    for (int k = 0; k < 3; ++k) WriteBinary(out, std::int32_t{0});
  }
  for (int f = 0; f < plate.frames; ++f) {
    for (int i = 0; i < points; ++i) {
      const Eigen::Vector3d p =
          plate.PointAt(-0.16 + 0.08 * (i % 5), -0.12 + 0.06 * (i / 5), f);
      const Eigen::Vector3f world =
          (BentPlate::TrueWorldFromWorld() * p).cast<float>();
      out.write(reinterpret_cast<const char*>(world.data()), 12);
    }
  }
  for (int i = 0; i < points * plate.frames; ++i) {
    WriteBinary(out, std::uint8_t{1});
  }
}

/// Adds a mesh (world of the run) to what the camera sees in a frame.
void Render(const BentPlate& plate, const TriangleMesh& mesh, int frame,
            Raster* raster) {
  const TriangleMesh seen = Moved(mesh, plate.WorldFromCamera(frame).inverse());
  RasterizeTriangles(seen.vertices, seen.triangles, BentPlate::Camera(), false,
                     0, raster);
}

/// HxW 8UC1, 1 where the plate is, and the depth of plate and wall, metres.
cv::Mat RenderScene(const BentPlate& plate, int frame, cv::Mat* depth) {
  Raster raster;
  raster.Clear(BentPlate::Camera());
  Render(plate, plate.PlateAt(frame), frame, &raster);
  cv::Mat labels = raster.depth > 0;
  labels /= 255;
  Render(plate, BentPlate::Wall(), frame, &raster);
  raster.depth.copyTo(*depth);
  return labels;
}

void WriteLabel(const std::string& path, const BentPlate& plate, int frame) {
  cv::Mat depth;
  cv::imwrite(path, RenderScene(plate, frame, &depth));
}

/// Images of one frame, and its mask.
void WriteFrame(const fs::path& folder, const fs::path& run,
                const BentPlate& plate, int frame) {
  const std::string name = BentPlate::Stem(frame) + ".png";
  cv::Mat depth;
  cv::Mat labels = RenderScene(plate, frame, &depth);
  labels.convertTo(labels, CV_16U);
  cv::imwrite((run / "masks" / name).string(), labels);
  cv::imwrite((folder / "rgb" / name).string(),
              cv::Mat::zeros(depth.size(), CV_8UC3));
  depth.convertTo(depth, CV_16U, 5000);
  cv::imwrite((folder / "depth" / name).string(), depth);
}

Trajectory TrajectoryOf(const BentPlate& plate, const Rigid3d& world_motion) {
  Trajectory trajectory;
  for (int f = 0; f < plate.frames; ++f) {
    trajectory.push_back(
        {BentPlate::Timestamp(f), world_motion * plate.WorldFromCamera(f)});
  }
  return trajectory;
}

}  // namespace

PinholeCamera BentPlate::Camera() { return {160, 120, 130, 130, 79.5, 59.5}; }

double BentPlate::Timestamp(int frame) { return 1000 + frame / 30.0; }

std::string BentPlate::Stem(int frame) {
  return "stem" + std::to_string(frame);
}

Rigid3d BentPlate::TrueWorldFromWorld() {
  Rigid3d motion(Eigen::Translation3d(3, -1, 0.5) *
                 Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()));
  return motion;
}

Rigid3d BentPlate::WorldFromCamera(int frame) const {
  const double s = 0.01 * frame;
  return Eigen::Translation3d(s, 0.05 * std::sin(10 * s), s * s) *
         Eigen::AngleAxisd(0.3 * s, Eigen::Vector3d::UnitY());
}

Eigen::Vector3d BentPlate::PointAt(double x, double y, int frame) const {
  const double curvature = curvature_step * frame;
  if (curvature == 0) return {x, y, 1};
  const double angle = curvature * x;
  return {std::sin(angle) / curvature, y,
          1 + (1 - std::cos(angle)) / curvature};
}

TriangleMesh BentPlate::PlateAt(int frame) const {
  TriangleMesh mesh = Grid(41, 31, -kHalfWidth, -kHalfHeight, 0.01, 1);
  for (Eigen::Vector3f& v : mesh.vertices) {
    v = PointAt(v.x(), v.y(), frame).cast<float>();
  }
  return mesh;
}

TriangleMesh BentPlate::Wall() { return Grid(21, 21, -1, -1, 0.1, 1.5); }

void BentPlate::WriteRun(const std::string& folder) const {
  const fs::path root(folder);
  WriteTumTrajectory((root / "trajectory.txt").string(),
                     TrajectoryOf(*this, Rigid3d::Identity()));
  std::ofstream lines(root / "frames.jsonl");
  for (int f = 0; f < frames; ++f) {
    lines << nlohmann::json{{"frame", f}, {"stem", Stem(f)}} << '\n';
  }
  std::ofstream(root / "calibration.txt") << "130 130 79.5 59.5 160 120 5000\n";
  MotionHistory wall;
  MotionHistory plate;
  const DeformationGraph graph = PlateGraph();
  for (int f = 0; f < frames; ++f) {
    wall.Append(
        {f, true, MakeRigidGraph(WorldFromCamera(f).inverse()).motions});
    if (f < first_frame) continue;
    FrameMotions frame{f, true, {}};
    for (const Eigen::Vector3d& g : graph.positions) {
      frame.motions.push_back(PlateMotion(*this, g, f));
    }
    plate.Append(std::move(frame));
  }
  WriteSurface(root / "surfaces/000_background", Wall(),
               MakeRigidGraph(Rigid3d::Identity()), wall);
  WriteSurface(root / "surfaces/001_thin_plate", PlateAt(0), graph, plate);
}

void BentPlate::WriteGroundTruth(const std::string& folder) const {
  const fs::path root(folder);
  fs::create_directories(root / "label");
  WriteTumTrajectory((root / "groundtruth.txt").string(),
                     TrajectoryOf(*this, TrueWorldFromWorld()));
  std::ofstream(root / "labels.json")
      << R"({"instances": [{"id": 1, "name": "plate1"}]})";
  WriteStaticMesh(root / "static_mesh.ply",
                  Moved(Wall(), TrueWorldFromWorld()));
  for (const int f : {0, 6}) {
    WritePly(
        (root / "mesh" / ("inst1_" + std::to_string(Timestamp(f)) + ".ply"))
            .string(),
        Moved(PlateAt(f), TrueWorldFromWorld()));
    WriteLabel((root / "label" / (Stem(f) + ".png")).string(), *this, f);
  }
  WriteTracks(root / "tracks.bin", *this);
}

void BentPlate::WriteSequence(const std::string& folder,
                              const std::string& run) const {
  const fs::path root(folder);
  fs::create_directories(root / "rgb");
  fs::create_directories(root / "depth");
  fs::create_directories(fs::path(run) / "masks");
  std::ofstream list(root / "associations.txt");
  list.precision(12);
  for (int f = 0; f < frames; ++f) {
    WriteFrame(root, run, *this, f);
    list << Timestamp(f) << " rgb/" << Stem(f) << ".png " << Timestamp(f)
         << " depth/" << Stem(f) << ".png\n";
  }
  std::ofstream(fs::path(run) / "options.flags")
      << "--max_depth=5\n--min_depth=0.4\n--sequence=" << folder << '\n';
}

}  // namespace splitfusion
