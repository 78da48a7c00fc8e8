#include "splitfusion/lib/synthetic/synthetic_scene.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/synthetic/detections.h"
#include "splitfusion/lib/synthetic/hash_noise.h"
#include "splitfusion/lib/synthetic/kinect_noise.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

constexpr double kFirstTimestamp = 1700000000;  // Seconds.
constexpr double kLensBlurPx = 0.6;             // At 640 pixels of width.
constexpr double kColorSigma = 2.0;             // Of 255.

/// Independent streams of random numbers of one frame.
enum FrameStream { kDepthStream = 1, kColorStream, kMaskStream };

std::uint32_t FrameSeed(std::uint32_t seed, int frame, FrameStream stream) {
  return HashCell(frame, stream, 0, seed);
}

cv::Mat FinishColor(const cv::Mat_<cv::Vec3f>& color, bool noise,
                    std::uint32_t seed) {
  cv::Mat blurred;
  const double sigma = kLensBlurPx * color.cols / 640.0;
  cv::GaussianBlur(color * 255, blurred, cv::Size(3, 3), sigma);
  if (noise) {
    cv::RNG random(seed + 0x9e3779b97f4a7c15ull);
    cv::Mat_<cv::Vec3f> grain(color.size());
    random.fill(grain, cv::RNG::NORMAL, 0, kColorSigma);
    blurred += grain;
  }
  cv::Mat bytes;
  blurred.convertTo(bytes, CV_8UC3);
  return bytes;
}

std::vector<double> CumulativeAreas(const TriangleMesh& mesh) {
  std::vector<double> sums;
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3f& a = mesh.vertices[t[0]];
    sum += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    sums.push_back(sum);
  }
  return sums;
}

/// Points of equal share of the area, each at a random place of its triangle.
std::vector<ScenePoint> SampleSurface(const TriangleMesh& mesh, int instance,
                                      int count, std::uint32_t seed) {
  const std::vector<double> sums = CumulativeAreas(mesh);
  std::vector<ScenePoint> points;
  for (int i = 0; i < count; ++i) {
    const double at =
        (i + HashUnit(i, 0, instance, seed)) / count * sums.back();
    const auto found = std::lower_bound(sums.begin(), sums.end(), at);
    ScenePoint point;
    point.instance = instance;
    point.triangle = static_cast<int>(
        std::min<std::ptrdiff_t>(found - sums.begin(), sums.size() - 1));
    point.b1 = HashUnit(i, 1, instance, seed);
    point.b2 = HashUnit(i, 2, instance, seed);
    if (point.b1 + point.b2 > 1) {
      point.b1 = 1 - point.b1;
      point.b2 = 1 - point.b2;
    }
    points.push_back(point);
  }
  return points;
}

/// True if a camera-frame point is on the surface that the pixel shows: it may
/// lie behind the pixel's depth only by what the slope explains.
bool IsSeen(const Vector3f& point, int instance, const SyntheticFrame& frame,
            const PinholeCamera& camera) {
  const auto pixel = camera.PixelOf(point);
  if (!pixel) return false;
  const int u = pixel->x(), v = pixel->y();
  const cv::Rect inner(1, 1, camera.width - 2, camera.height - 2);
  if (!inner.contains(cv::Point(u, v)) ||
      frame.labels.at<unsigned char>(v, u) != instance) {
    return false;
  }
  const float depth = frame.true_depth.at<float>(v, u);
  float slope = 0;
  for (const cv::Point& side :
       {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
    const cv::Point at = cv::Point(u, v) + side;
    if (frame.labels.at<unsigned char>(at) != instance) continue;
    slope = std::max(slope, std::abs(frame.true_depth.at<float>(at) - depth));
  }
  return std::abs(point.z() - depth) < 0.003f + std::min(slope, 0.02f);
}

std::vector<Vector3f> ToCamera(const Rigid3d& world_from_camera,
                               std::vector<Vector3f> points) {
  const Rigid3f camera_from_world = world_from_camera.inverse().cast<float>();
  for (Vector3f& point : points) point = camera_from_world * point;
  return points;
}

std::vector<Vector3f> RotateToCamera(const Rigid3d& world_from_camera,
                                     std::vector<Vector3f> normals) {
  const Eigen::Matrix3f rotation =
      world_from_camera.linear().transpose().cast<float>();
  for (Vector3f& normal : normals) normal = rotation * normal;
  return normals;
}

}  // namespace

SyntheticScene::SyntheticScene(const SyntheticOptions& options)
    : options_((options.Check(), options)),
      camera_(SyntheticCamera(options)),
      camera_path_(options),
      body_motion_(options.scene == SyntheticSceneKind::kRoomPerson) {
  const auto kind = options.scene;
  const bool all = kind == SyntheticSceneKind::kRoomPerson;
  if (all || kind == SyntheticSceneKind::kRoom) {
    room_ = MakeRoom(options.seed);
  }
  if (all || kind == SyntheticSceneKind::kPerson) {
    body_ = std::make_unique<BodyModel>(options.seed);
  }
  if (all || kind == SyntheticSceneKind::kSoftObject) {
    const Vector3f base = all ? RoomTableTop() : Vector3f::Zero();
    soft_object_ = std::make_unique<SoftObject>(base, options.seed);
  }
  AddInstances();
  AddTrackPoints();
}

void SyntheticScene::AddInstances() {
  if (body_) {
    instances_.push_back({kPersonId, "person1", "person", false, true});
  }
  if (soft_object_) {
    instances_.push_back({kSoftObjectId, "toy", "teddy bear", false, true});
  }
  if (!room_.solids.empty()) {
    instances_.push_back({kChairId, "chair1", "chair", true, false});
  }
}

void SyntheticScene::AddTrackPoints() {
  for (const SyntheticInstance& instance : instances_) {
    if (instance.rigid || options_.track_points == 0) continue;
    const auto points = SampleSurface(RestMesh(instance.id).mesh, instance.id,
                                      options_.track_points, options_.seed);
    track_points_.insert(track_points_.end(), points.begin(), points.end());
  }
}

double SyntheticScene::Timestamp(int frame) const {
  return kFirstTimestamp + frame / options_.frame_rate;
}

std::string SyntheticScene::Stem(int frame) const {
  return cv::format("%.6f", Timestamp(frame));
}

Rigid3d SyntheticScene::WorldFromCamera(int frame) const {
  return camera_path_.WorldFromCamera(frame / options_.frame_rate);
}

double SyntheticScene::SubjectTime(int frame) const {
  return options_.subject_speed * frame / options_.frame_rate;
}

const TexturedMesh& SyntheticScene::RestMesh(int instance) const {
  if (instance == kPersonId && body_) return body_->rest();
  if (instance == kSoftObjectId && soft_object_) return soft_object_->rest();
  throw InputError("instance = " + std::to_string(instance) +
                   ": expected a moving instance of the scene");
}

std::vector<Vector3f> SyntheticScene::PosedVertices(int instance,
                                                    int frame) const {
  const double time = SubjectTime(frame);
  return instance == kPersonId ? body_->Vertices(body_motion_.PoseAt(time))
                               : soft_object_->Vertices(time);
}

TriangleMesh SyntheticScene::PosedMesh(int instance, int frame) const {
  TriangleMesh mesh;
  mesh.triangles = RestMesh(instance).mesh.triangles;
  mesh.vertices = PosedVertices(instance, frame);
  mesh.normals = ComputeVertexNormals(mesh);
  return mesh;
}

std::vector<PosedSurface> SyntheticScene::PosedSurfaces(int frame) const {
  const Rigid3d pose = WorldFromCamera(frame);
  std::vector<PosedSurface> surfaces;
  if (!room_.solids.empty()) {
    surfaces.push_back({&room_.surface,
                        ToCamera(pose, room_.surface.mesh.vertices),
                        RotateToCamera(pose, room_.surface.mesh.normals)});
  }
  for (const SyntheticInstance& instance : instances_) {
    if (!instance.moving) continue;
    TriangleMesh mesh = PosedMesh(instance.id, frame);
    surfaces.push_back({&RestMesh(instance.id),
                        ToCamera(pose, std::move(mesh.vertices)),
                        RotateToCamera(pose, std::move(mesh.normals))});
  }
  return surfaces;
}

SyntheticFrame SyntheticScene::Render(int frame) const {
  CheckOption(frame >= 0 && frame < options_.frames, "frame", frame,
              "0 to " + std::to_string(options_.frames - 1));
  SyntheticFrame result;
  result.world_from_camera = WorldFromCamera(frame);
  const RenderedScene rendered =
      RenderSurfaces(PosedSurfaces(frame), camera_, result.world_from_camera);
  result.true_depth = rendered.depth;
  result.labels = rendered.label;
  result.frame.index = frame;
  result.frame.timestamp = Timestamp(frame);
  result.frame.stem = Stem(frame);
  result.frame.color =
      FinishColor(rendered.color, options_.noise,
                  FrameSeed(options_.seed, frame, kColorStream));
  result.frame.depth =
      options_.noise
          ? ApplyKinectNoise(rendered.depth, camera_,
                             FrameSeed(options_.seed, frame, kDepthStream))
          : rendered.depth.clone();
  return result;
}

std::vector<InstanceMask> SyntheticScene::Detections(
    const SyntheticFrame& frame) const {
  std::map<int, std::string> class_names;
  for (const SyntheticInstance& instance : instances_) {
    class_names[instance.id] = instance.category;
  }
  const DetectorFaults faults =
      options_.exact_masks ? ExactDetector() : DetectorFaults();
  return ImitateDetections(
      frame.labels, class_names, faults,
      FrameSeed(options_.seed, frame.frame.index, kMaskStream));
}

std::vector<Vector3f> SyntheticScene::TrackPositions(int frame) const {
  std::map<int, std::vector<Vector3f>> vertices;
  for (const SyntheticInstance& instance : instances_) {
    if (instance.rigid) continue;
    vertices[instance.id] = PosedVertices(instance.id, frame);
  }
  std::vector<Vector3f> positions;
  for (const ScenePoint& point : track_points_) {
    const auto& posed = vertices.at(point.instance);
    const Eigen::Vector3i& t =
        RestMesh(point.instance).mesh.triangles[point.triangle];
    positions.push_back((1 - point.b1 - point.b2) * posed[t[0]] +
                        point.b1 * posed[t[1]] + point.b2 * posed[t[2]]);
  }
  return positions;
}

std::vector<bool> SyntheticScene::TrackVisibility(
    const SyntheticFrame& frame) const {
  const auto points =
      ToCamera(frame.world_from_camera, TrackPositions(frame.frame.index));
  std::vector<bool> visible;
  for (std::size_t i = 0; i < points.size(); ++i) {
    visible.push_back(
        IsSeen(points[i], track_points_[i].instance, frame, camera_));
  }
  return visible;
}

}  // namespace splitfusion
