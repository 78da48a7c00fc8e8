#include "splitfusion/lib/split/surface_splitter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/split/detection_screen.h"
#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/surface_contact.h"
#include "splitfusion/lib/split/surface_extent.h"

namespace splitfusion {
namespace {

/// Frames in which a detection covers a second surface before the two are
/// taken for one.
constexpr int kCoveredFrames = 3;

/// So early hardly any background is mapped that could speak against a birth.
constexpr int kEarlyFrames = 10;

void CheckSize(const std::string& name, const cv::Mat& image,
               const PinholeCamera& camera) {
  if (image.cols == camera.width && image.rows == camera.height) return;
  throw InputError(name + " is " + std::to_string(image.cols) + "x" +
                   std::to_string(image.rows) + ": expected " +
                   std::to_string(camera.width) + "x" +
                   std::to_string(camera.height));
}

cv::Mat_<uchar> PixelsOf(int index, const LabelImage& segment_labels) {
  return segment_labels == index + 1;
}

int CountWithDepth(const cv::Mat& pixels, const cv::Mat& depth) {
  return cv::countNonZero(pixels & (depth > 0));
}

}  // namespace

SurfaceSplitter::SurfaceSplitter(const PinholeCamera& camera, LabelTable table,
                                 SplitOptions options)
    : camera_(camera),
      table_(std::move(table)),
      options_(std::move(options)),
      births_(4 * options_.birth_frames) {
  camera_.Check();
  options_.Check();
}

SplitResult SurfaceSplitter::Split(const Frame& frame, const PointMap& points,
                                   const std::vector<InstanceMask>& detections,
                                   const SurfacePrediction& prediction) {
  CheckSizes(frame, detections, prediction);
  ++frames_;
  Work work{frame, points, {}, {}, {}, {}, {}, {}};
  work.prior = CompletePrediction(prediction, last_, registry_.Followed(),
                                  {camera_.width, camera_.height});
  work.compared = CompareDepth(frame.depth, work.prior, options_.prior);
  CollectSegments(detections, &work);
  AddMissedSurfaces(&work);
  CutSegments(&work);
  work.segment_labels =
      ComposeSegments(work.segments, work.prior.labels, frame.depth);
  SettleSurfaces(&work);
  MergeCoveredSurfaces(&work);
  DrawLabels(&work);
  DrawUncertain(&work);
  Remember(work);
  return work.result;
}

void SurfaceSplitter::CheckSizes(const Frame& frame,
                                 const std::vector<InstanceMask>& detections,
                                 const SurfacePrediction& prediction) const {
  CheckSize("colour image", frame.color, camera_);
  CheckSize("depth image", frame.depth, camera_);
  for (const InstanceMask& detection : detections) {
    CheckSize("mask of '" + detection.class_name + "'", detection.mask,
              camera_);
  }
  if (prediction.labels.empty()) return;
  CheckSize("predicted labels", prediction.labels, camera_);
  CheckSize("predicted depth", prediction.depth, camera_);
  if (prediction.background.empty()) return;
  CheckSize("predicted background", prediction.background, camera_);
}

void SurfaceSplitter::CollectSegments(
    const std::vector<InstanceMask>& detections, Work* work) const {
  const std::vector<Candidate> candidates =
      ScreenDetections(detections, table_, options_);
  MatchOptions match_options;
  match_options.min_iou = options_.min_match_iou;
  const std::vector<Match> matches =
      MatchInstances(candidates, work->prior.labels, work->compared.agreement,
                     registry_.Matchable(), match_options);
  SortedDetections sorted = SortDetections(candidates, matches, table_,
                                           options_, work->frame.depth.size());
  work->segments = std::move(sorted.segments);
  work->unconfirmed = sorted.unconfirmed;
  work->result.decisions = std::move(sorted.decisions);
}

void SurfaceSplitter::AddMissedSurfaces(Work* work) const {
  std::set<int> missed = registry_.Followed();
  for (const Segment& segment : work->segments) missed.erase(segment.surface);
  for (const int id : missed) {
    Segment segment;
    segment.surface = id;
    segment.class_name = registry_.at(id).class_name;
    work->segments.push_back(segment);
  }
}

void SurfaceSplitter::CutSegments(Work* work) const {
  std::vector<Segment>& segments = work->segments;
  tbb::parallel_for(std::size_t{0}, segments.size(), [&](std::size_t i) {
    Segment& segment = segments[i];
    segment.evidence =
        GatherEvidence(Observe(static_cast<int>(i), *work), work->compared,
                       options_.graph_cut, options_.prior);
    if (segment.evidence.crop.area() == 0) return;
    segment.foreground =
        CutForeground(work->points, work->frame.color, segment.evidence.crop,
                      segment.evidence.evidence, options_.graph_cut);
  });
}

SurfaceObservation SurfaceSplitter::Observe(int index, const Work& work) const {
  const Segment& segment = work.segments[index];
  SurfaceObservation observation{
      segment.surface,
      segment.mask,
      MasksBut(index, work.segments, work.frame.depth.size()),
      support_.Predict(segment.surface, work.prior.labels),
      {}};
  if (segment.mask.empty()) {
    observation.extent = MissedExtent(segment.surface, observation.others,
                                      work.compared, work.frame.depth);
  }
  return observation;
}

void SurfaceSplitter::SettleSurfaces(Work* work) {
  const int count = static_cast<int>(work->segments.size());
  for (int i = 0; i < count; ++i) {
    const Segment& segment = work->segments[i];
    if (segment.surface == 0) continue;
    if (segment.mask.empty()) {
      const cv::Mat_<uchar> pixels = PixelsOf(i, work->segment_labels);
      SettleMissed(segment, CountWithDepth(pixels, work->frame.depth), work);
      continue;
    }
    const bool revived = registry_.at(segment.surface).dormant;
    registry_.RecordDetection(segment.surface, work->frame.index,
                              segment.class_name, segment.score);
    work->result.decisions.push_back(
        MakeDecision(revived ? "revived" : "matched", segment));
  }
  for (int i = 0; i < count; ++i) {
    if (work->segments[i].surface == 0) SettleNewcomer(i, work);
  }
}

void SurfaceSplitter::SettleMissed(const Segment& segment, int pixels,
                                   Work* work) {
  const int missed =
      work->frame.index - registry_.at(segment.surface).last_detected_frame;
  const bool gone =
      missed > options_.max_missed_frames || pixels < options_.min_pixels / 4;
  if (gone) registry_.SetDormant(segment.surface);
  work->result.decisions.push_back(
      MakeDecision(gone ? "dormant" : "missed", segment));
}

void SurfaceSplitter::SettleNewcomer(int index, Work* work) {
  Segment& segment = work->segments[index];
  const cv::Mat_<uchar> pixels = PixelsOf(index, work->segment_labels);
  if (const int body = FindBody(index, pixels, *work)) {
    segment.surface = body;
    work->result.decisions.push_back(MakeDecision("merged", segment));
    return;
  }
  const bool large =
      CountWithDepth(pixels, work->frame.depth) >= options_.min_pixels;
  // Who is known needs no confirmation.
  const int known = large ? FindKnown(segment, pixels, *work) : 0;
  if (known > 0 || (large && IsConfirmed(segment, pixels, *work))) {
    AddSurface(known, &segment, work);
    return;
  }
  work->unconfirmed |= segment.mask | pixels;
  work->result.decisions.push_back(
      MakeDecision(large ? "pending" : "ignored", segment));
}

int SurfaceSplitter::FindBody(int index, const cv::Mat_<uchar>& pixels,
                              const Work& work) const {
  int best = 0;
  double best_share = options_.min_contact;
  for (int i = 0; i < static_cast<int>(work.segments.size()); ++i) {
    const int id = work.segments[i].surface;
    const bool alike =
        i != index && id > 0 &&
        registry_.at(id).class_name == work.segments[index].class_name;
    if (!alike) continue;
    const double share =
        ContactShare(work.points, pixels, PixelsOf(i, work.segment_labels));
    if (share < best_share) continue;
    best_share = share;
    best = id;
  }
  return best;
}

bool SurfaceSplitter::IsConfirmed(const Segment& segment,
                                  const cv::Mat_<uchar>& pixels,
                                  const Work& work) {
  const int hits = births_.Add(work.frame.index, segment.mask);
  if (frames_ == 1 && segment.score >= options_.confident_score) return true;
  const cv::Mat mapped =
      pixels & (work.prior.labels == 0) &
      (work.compared.agreement == static_cast<int>(Agreement::kSame));
  const bool was_background =
      frames_ > kEarlyFrames &&
      2 * cv::countNonZero(mapped) > cv::countNonZero(pixels);
  return hits >= options_.birth_frames * (was_background ? 2 : 1);
}

int SurfaceSplitter::FindKnown(const Segment& segment,
                               const cv::Mat_<uchar>& pixels,
                               const Work& work) const {
  return registry_.FindDormant(
      ComputeAppearance(work.frame.color, work.points, pixels),
      table_.Kind(segment.class_name));
}

void SurfaceSplitter::AddSurface(int known, Segment* segment, Work* work) {
  births_.Remove(segment->mask);
  segment->surface =
      known > 0 ? known
                : registry_.Create(work->frame.index, segment->class_name,
                                   table_.Kind(segment->class_name));
  registry_.RecordDetection(segment->surface, work->frame.index,
                            segment->class_name, segment->score);
  work->result.decisions.push_back(
      MakeDecision(known > 0 ? "revived" : "born", *segment));
}

void SurfaceSplitter::MergeCoveredSurfaces(Work* work) {
  for (Segment& part : work->segments) {
    if (part.surface == 0 || !part.mask.empty()) continue;
    for (std::size_t i = 0; i < work->segments.size(); ++i) {
      const Segment& body = work->segments[i];
      if (!IsCovered(part, static_cast<int>(i), *work)) continue;
      const int hits = registry_.CountCovered(part.surface, body.surface);
      if (hits < kCoveredFrames) continue;
      registry_.Merge(part.surface, body.surface);
      work->result.decisions.push_back(MakeDecision("merged", part));
      part.surface = body.surface;
      break;
    }
  }
}

bool SurfaceSplitter::IsCovered(const Segment& part, int body_index,
                                const Work& work) const {
  const Segment& body = work.segments[body_index];
  if (body.mask.empty() || body.surface == 0 ||
      registry_.at(body.surface).class_name != part.class_name) {
    return false;
  }
  const Overlap overlap = ComputeOverlap(
      body.mask, part.surface, work.prior.labels, work.compared.agreement);
  const MatchOptions limits;
  if (overlap.covered * overlap.agreement < limits.min_contained) return false;
  const cv::Mat_<uchar> seen =
      AgreeingPixels(part.surface, work.prior.labels, work.compared.agreement);
  return ContactShare(work.points, seen,
                      PixelsOf(body_index, work.segment_labels)) >=
         options_.min_contact;
}

void SurfaceSplitter::DrawLabels(Work* work) const {
  std::vector<std::uint16_t> id_of(work->segments.size() + 1, 0);
  for (std::size_t i = 0; i < work->segments.size(); ++i) {
    const int id = work->segments[i].surface;
    if (id > 0 && !registry_.at(id).dormant) {
      id_of[i + 1] = static_cast<std::uint16_t>(id);
    }
  }
  work->result.labels.create(work->segment_labels.size());
  std::transform(work->segment_labels.begin(), work->segment_labels.end(),
                 work->result.labels.begin(),
                 [&](std::uint16_t segment) { return id_of[segment]; });
}

void SurfaceSplitter::DrawUncertain(Work* work) const {
  const LabelImage& labels = work->result.labels;
  UncertainInput input{labels,
                       work->unconfirmed,
                       MasksBut(-1, work->segments, labels.size()),
                       work->prior.labels.clone(),
                       work->compared.agreement,
                       work->frame.depth};
  cv::Mat_<uchar> missed(labels.size(), uchar(0));
  for (const Segment& segment : work->segments) {
    if (segment.mask.empty()) missed |= labels == segment.surface;
  }
  input.unconfirmed |=
      Protrusions(labels, missed, work->compared, work->frame.depth);
  for (const auto& [id, instance] : registry_.instances()) {
    if (!instance.dormant) continue;
    input.predicted_labels.setTo(0, work->prior.labels == id);
  }
  work->result.uncertain = DrawUncertainRegion(input, options_.uncertain);
}

void SurfaceSplitter::Remember(const Work& work) {
  for (const Segment& segment : work.segments) {
    if (segment.surface == 0 || segment.mask.empty()) continue;
    const cv::Mat_<uchar> pixels = work.result.labels == segment.surface;
    registry_.RecordAppearance(
        segment.surface,
        ComputeAppearance(work.frame.color, work.points, pixels));
    support_.Update(segment.surface, pixels, segment.mask, work.prior.labels);
  }
  last_ = {work.result.labels.clone(), work.frame.depth.clone(), {}};
  last_.depth.setTo(0, work.result.uncertain);
}

}  // namespace splitfusion
