#include "splitfusion/lib/report/run_paths.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <opencv2/core.hpp>
#include <utility>

namespace splitfusion {
namespace {

/// File systems take 255 bytes; the id at the beginning keeps names apart.
constexpr std::size_t kMaxSurfaceName = 64;

bool IsPlain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.';
}

}  // namespace

RunPaths::RunPaths(std::string root) : root_(std::move(root)) {}

std::string RunPaths::Marker() const { return Below("run.json"); }
std::string RunPaths::Lock() const { return Below("lock"); }
std::string RunPaths::Unfinished() const { return Below("unfinished"); }
std::string RunPaths::Checkpoint() const { return Below("checkpoint.bin"); }
std::string RunPaths::Options() const { return Below("options.flags"); }
std::string RunPaths::Calibration() const { return Below("calibration.txt"); }
std::string RunPaths::ColorCamera() const { return Below("color_camera.txt"); }
std::string RunPaths::Trajectory() const { return Below("trajectory.txt"); }
std::string RunPaths::Frames() const { return Below("frames.jsonl"); }
std::string RunPaths::Iterations() const { return Below("iterations.csv"); }
std::string RunPaths::Refinement() const { return Below("refinement.jsonl"); }
std::string RunPaths::HiddenDeviations() const {
  return Below("hidden_deviations.csv");
}
std::string RunPaths::Summary() const { return Below("summary.json"); }
std::string RunPaths::Evaluation() const { return Below("evaluation.json"); }
std::string RunPaths::HtmlReport() const { return Below("report.html"); }
std::string RunPaths::Pictures() const { return Below("pictures"); }
std::string RunPaths::Detections() const { return Below("detections"); }

std::string RunPaths::Problem(int frame, int surface, bool first) const {
  return Below("problems/" + FrameName(frame) + cv::format("_%03d", surface) +
               (first ? "_first.h5" : ".h5"));
}

std::string RunPaths::HiddenProblem(int frame, int surface, int part) const {
  return Below("problems/" + FrameName(frame) +
               cv::format("_%03d_hidden_%d.h5", surface, part));
}

std::string RunPaths::Uncertainty(int frame, int surface) const {
  return Below("uncertainty/" + FrameName(frame) +
               cv::format("_%03d.ply", surface));
}

std::string RunPaths::Surface(int id, const std::string& label) const {
  return Below("surfaces/" + SurfaceName(id, label));
}

std::string RunPaths::WarpedMesh(int id, const std::string& label,
                                 int frame) const {
  return Surface(id, label) + "/warped/" + FrameName(frame) + ".ply";
}

std::string RunPaths::SurfaceName(int id, const std::string& label) {
  std::string name = cv::format("%03d_", id) + label;
  for (char& c : name) {
    if (!IsPlain(c)) c = '_';
  }
  return name.substr(0, kMaxSurfaceName);
}

bool RunPaths::IsOfRun(const std::string& name) {
  const RunPaths here("");
  const std::array<std::string, 21> names = {
      here.Marker(),      here.Checkpoint(),  "checkpoints",
      here.Options(),     here.Calibration(), here.Trajectory(),
      here.Frames(),      here.Iterations(),  here.Summary(),
      here.Evaluation(),  here.HtmlReport(),  here.Pictures(),
      here.Detections(),  "solver",           "masks",
      "surfaces",         "problems",         "uncertainty",
      here.ColorCamera(), here.Refinement(),  here.HiddenDeviations()};
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string RunPaths::FrameName(int frame) { return cv::format("%06d", frame); }

std::string RunPaths::Below(const std::string& name) const {
  return (std::filesystem::path(root_) / name).string();
}

}  // namespace splitfusion
