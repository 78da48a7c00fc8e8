#include "splitfusion/lib/evaluation/model_inspection.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "splitfusion/lib/evaluation/posed_model.h"

namespace splitfusion {
namespace {

/// The shape of one surface in one frame.
struct FrameShape {
  StretchedArea stretch;
  StrayArea stray;
};

/// What one frame shows.
struct FrameInspection {
  int frame = 0;
  std::map<int, FrameShape> shapes;           // By surface.
  std::map<int, InstanceSighting> sightings;  // By instance.
};

/// Looks at single frames.
class Inspector {
 public:
  Inspector(const RecordedRun& run,
            const std::vector<AnimatedSurface>& surfaces,
            const LiveImages* live, const InstanceLabels& labels)
      : run_(run), surfaces_(surfaces), live_(live), labels_(labels) {}

  FrameInspection Look(const RecordedFrame& frame) const {
    FrameInspection result;
    result.frame = frame.index;
    cv::Mat_<float> depth;
    cv::Mat_<std::uint16_t> labels;
    if (live_ != nullptr) {
      depth = live_->Depth(frame);
      labels = ReadIds(labels_.folder, frame, live_->camera());
      if (!labels.empty()) AddSightings(frame, depth, labels, &result);
    }
    for (const AnimatedSurface& surface : surfaces_) {
      if (surface.background() || !surface.HasMotions(frame.index)) continue;
      AddSurface(surface, depth, labels, &result);
    }
    return result;
  }

 private:
  void AddSightings(const RecordedFrame& frame, const cv::Mat_<float>& depth,
                    const cv::Mat_<std::uint16_t>& labels,
                    FrameInspection* result) const {
    std::map<int, int> live_pixels = CountPixels(labels, &depth);
    const RecordedFrame* before = run_.Find(frame.index - kEntryFrames);
    cv::Mat_<std::uint16_t> labels_before;
    if (before != nullptr) {
      labels_before = ReadIds(labels_.folder, *before, live_->camera());
    }
    std::map<int, int> earlier = CountPixels(labels_before, nullptr);
    for (const int instance : labels_.instances) {
      InstanceSighting& sighting = result->sightings[instance];
      sighting.frame = frame.index;
      sighting.live_pixels = live_pixels[instance];
      if (!labels_before.empty()) sighting.earlier_pixels = earlier[instance];
    }
  }

  void AddSurface(const AnimatedSurface& surface, const cv::Mat_<float>& depth,
                  const cv::Mat_<std::uint16_t>& labels,
                  FrameInspection* result) const {
    StretchedArea stretch;
    const TriangleMesh mesh = surface.MeshAt(result->frame, &stretch);
    if (mesh.triangles.empty()) return;
    const int id = surface.recorded().id;
    FrameShape& shape = result->shapes[id];
    shape.stretch = stretch;
    if (depth.empty()) return;
    shape.stray = MeasureStray(mesh, live_->camera(), depth);
    if (labels.empty()) return;
    cv::Mat_<std::uint16_t> shown = labels.clone();
    shown.setTo(0, ShownPixels(mesh, live_->camera(), depth) == 0);
    std::map<int, int> pixels = CountPixels(shown, &depth);
    for (auto& [instance, sighting] : result->sightings) {
      if (pixels[instance] == 0) continue;
      sighting.shares[id] =
          static_cast<double>(pixels[instance]) / sighting.live_pixels;
    }
  }

  const RecordedRun& run_;
  const std::vector<AnimatedSurface>& surfaces_;
  const LiveImages* live_;
  const InstanceLabels& labels_;
};

void AddShare(double share, int frame, ShareOverFrames* shares) {
  shares->mean += share;  // A sum until the end.
  if (shares->worst_frame >= 0 && share <= shares->worst) return;
  shares->worst = share;
  shares->worst_frame = frame;
}

void AddShape(const FrameShape& item, int frame, SurfaceShape* shape) {
  ++shape->frames;
  AddShare(item.stretch.Share(), frame, &shape->stretched);
  shape->stretched_triangles =
      std::max(shape->stretched_triangles, item.stretch.triangles);
  shape->longest_edge =
      std::max(shape->longest_edge, item.stretch.longest_edge);
  if (shape->stray) AddShare(item.stray.Share(), frame, &*shape->stray);
}

std::vector<SurfaceShape> Shapes(const std::vector<AnimatedSurface>& surfaces,
                                 bool with_stray,
                                 const std::vector<FrameInspection>& frames) {
  std::vector<SurfaceShape> shapes;
  for (const AnimatedSurface& surface : surfaces) {
    if (surface.background()) continue;
    SurfaceShape shape;
    shape.surface_id = surface.recorded().id;
    shape.surface_label = surface.recorded().label;
    if (with_stray) shape.stray.emplace();
    for (const FrameInspection& frame : frames) {
      const auto found = frame.shapes.find(shape.surface_id);
      if (found == frame.shapes.end()) continue;
      AddShape(found->second, frame.frame, &shape);
    }
    const double count = std::max(1, shape.frames);
    shape.stretched.mean /= count;
    if (shape.stray) shape.stray->mean /= count;
    shapes.push_back(shape);
  }
  return shapes;
}

}  // namespace

ModelInspection InspectModels(const RecordedRun& run,
                              const std::vector<AnimatedSurface>& surfaces,
                              const LiveImages* live,
                              const InstanceLabels& labels, int every) {
  const Inspector inspector(run, surfaces, live, labels);
  const std::size_t count = (run.frames.size() + every - 1) / every;
  std::vector<FrameInspection> frames(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    frames[i] = inspector.Look(run.frames[i * every]);
  });
  ModelInspection result;
  result.shapes = Shapes(surfaces, live != nullptr, frames);
  for (const FrameInspection& frame : frames) {
    for (const auto& [instance, sighting] : frame.sightings) {
      result.sightings[instance].push_back(sighting);
    }
  }
  return result;
}

}  // namespace splitfusion
