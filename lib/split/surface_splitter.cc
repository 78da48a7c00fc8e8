#include "splitfusion/lib/split/surface_splitter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/split/detection_screen.h"
#include "splitfusion/lib/split/held_parts.h"
#include "splitfusion/lib/split/hidden_instances.h"
#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/loose_parts.h"
#include "splitfusion/lib/split/surface_extent.h"
#include "splitfusion/lib/split/surface_merging.h"

namespace splitfusion {
namespace {

/// So early hardly any background is mapped that could speak against a birth.
constexpr int kEarlyFrames = 10;

/// Share of the background that agrees with the map when the pose is right.
constexpr double kMinFit = 0.7;

void CheckSize(const std::string& name, const cv::Mat& image,
               const PinholeCamera& camera) {
  if (image.cols == camera.width && image.rows == camera.height) return;
  throw InputError(name + " is " + std::to_string(image.cols) + "x" +
                   std::to_string(image.rows) + ": expected " +
                   std::to_string(camera.width) + "x" +
                   std::to_string(camera.height));
}

/// A surface of fewer pixels with depth is not followed on.
int MinFollowedPixels(const SplitOptions& options) {
  return options.min_pixels / 4;
}

int CountWithDepth(const cv::Mat& pixels, const cv::Mat& depth) {
  return cv::countNonZero(pixels & (depth > 0));
}

/// Whether most of what is background by the prior, outside of detections, is
/// where it was mapped; true if nothing is known of it.
bool BackgroundFits(const std::vector<Candidate>& candidates,
                    const SplitWork& work) {
  cv::Mat_<uchar> open = work.compared.labels == 0;
  for (const Candidate& candidate : candidates) open.setTo(0, candidate.mask);
  const cv::Mat_<uchar>& agreement = work.compared.agreement;
  open.setTo(0, agreement == static_cast<int>(DepthState::kUnmeasured));
  const int same = cv::countNonZero(
      open & (agreement == static_cast<int>(DepthState::kObserved)));
  return same >= kMinFit * cv::countNonZero(open);
}

}  // namespace

SurfaceSplitter::SurfaceSplitter(const PinholeCamera& camera, LabelTable table,
                                 SplitOptions options)
    : camera_(camera),
      table_(std::move(table)),
      options_(std::move(options)),
      groups_(ParseMergeGroups(options_.merge_touching)),
      births_(4 * options_.birth_frames),
      objects_(camera, options_) {
  camera_.Check();
  options_.Check();
}

SplitResult SurfaceSplitter::Split(const Frame& frame, const PointMap& points,
                                   const std::vector<InstanceMask>& detections,
                                   const SurfacePrediction& prediction) {
  CheckSizes(frame, detections, prediction);
  ++frames_;
  SplitWork work{frame, points, {}, {}, {}, {}, {}, {}, {}};
  work.prior = CompletePrediction(prediction, last_, registry_.Followed(),
                                  {camera_.width, camera_.height});
  SplitHeldParts(registry_, last_.labels, &work.prior.labels);
  work.compared = CompareDepth(frame.depth, work.prior, options_.prior);
  CollectSegments(detections, &work);
  AddMissedSurfaces(&work);
  CutSegments(&work);
  work.segment_labels =
      ComposeSegments(work.segments, work.prior.labels, frame.depth);
  ClaimLooseParts(registry_, &work);
  SettleSurfaces(&work);
  SettleNewcomers(&work);
  MergeCoveredSurfaces(options_.min_contact, &registry_, &work);
  HoldTouchingParts(groups_, &registry_, &work);
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
    const std::vector<InstanceMask>& detections, SplitWork* work) {
  std::vector<Candidate> candidates =
      ScreenDetections(detections, table_, groups_, options_);
  const cv::Mat_<uchar> standing_free = WatchObjects(*work, &candidates);
  MatchOptions match_options;
  match_options.min_iou = options_.min_match_iou;
  std::vector<Match> matches =
      MatchInstances(candidates, work->prior.labels, work->compared.agreement,
                     registry_.Matchable(), match_options);
  RecognizeHidden(candidates, table_, registry_, *work, &matches);
  TakeOutParts(groups_, candidates, registry_, work, &matches);
  SortedDetections sorted = SortDetections(candidates, matches, table_,
                                           options_, work->frame.depth.size());
  work->segments = std::move(sorted.segments);
  work->unconfirmed = sorted.unconfirmed | standing_free;
  work->result.decisions = std::move(sorted.decisions);
}

cv::Mat_<uchar> SurfaceSplitter::WatchObjects(
    const SplitWork& work, std::vector<Candidate>* candidates) {
  cv::Mat_<uchar> claimed(work.frame.depth.size(), uchar(0));
  for (const Candidate& candidate : *candidates) {
    if (candidate.score >= options_.min_score &&
        IsTrackable(candidate.class_name, table_, options_)) {
      claimed |= candidate.mask;
    }
  }
  for (const int id : registry_.Followed()) {
    if (registry_.at(id).kind == SurfaceKind::kRigid) continue;
    claimed |= work.prior.labels == id;
  }
  return objects_.Watch({work.frame.index, work.frame.depth, work.points,
                         work.prior.world_from_camera,
                         BackgroundFits(*candidates, work), claimed},
                        table_, candidates);
}

void SurfaceSplitter::AddMissedSurfaces(SplitWork* work) const {
  std::set<int> missed = registry_.Followed();
  for (const Segment& segment : work->segments) missed.erase(segment.surface);
  for (const int id : missed) {
    Segment segment;
    segment.surface = id;
    segment.class_name = registry_.at(id).class_name;
    work->segments.push_back(segment);
  }
}

void SurfaceSplitter::CutSegments(SplitWork* work) const {
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

SurfaceObservation SurfaceSplitter::Observe(int index,
                                            const SplitWork& work) const {
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

void SurfaceSplitter::SettleSurfaces(SplitWork* work) {
  const int count = static_cast<int>(work->segments.size());
  for (int i = 0; i < count; ++i) {
    const Segment& segment = work->segments[i];
    if (segment.surface == 0) continue;
    if (segment.mask.empty()) {
      const cv::Mat_<uchar> pixels = SegmentPixels(i, work->segment_labels);
      SettleMissed(segment, CountWithDepth(pixels, work->frame.depth), work);
      continue;
    }
    const bool revived = registry_.at(segment.surface).dormant;
    registry_.RecordDetection(segment.surface, work->frame.index,
                              segment.class_name, segment.score);
    work->result.decisions.push_back(
        MakeDecision(revived ? "revived" : "matched", segment));
  }
}

void SurfaceSplitter::SettleMissed(const Segment& segment, int pixels,
                                   SplitWork* work) {
  const int missed =
      work->frame.index - registry_.at(segment.surface).last_detected_frame;
  const bool gone = missed > options_.max_missed_frames ||
                    pixels < MinFollowedPixels(options_);
  if (gone) registry_.SetDormant(segment.surface);
  work->result.decisions.push_back(
      MakeDecision(gone ? "dormant" : "missed", segment));
}

void SurfaceSplitter::SettleNewcomers(SplitWork* work) {
  // Parts that may be held come last: their holder may be new, too.
  for (const bool held : {false, true}) {
    for (std::size_t i = 0; i < work->segments.size(); ++i) {
      const Segment& segment = work->segments[i];
      if (segment.surface == 0 &&
          MayBeHeld(groups_, segment.class_name) == held) {
        SettleNewcomer(static_cast<int>(i), work);
      }
    }
  }
}

void SurfaceSplitter::SettleNewcomer(int index, SplitWork* work) {
  Segment& segment = work->segments[index];
  const cv::Mat_<uchar> pixels = SegmentPixels(index, work->segment_labels);
  if (const int body =
          FindBody(index, registry_, options_.min_contact, *work)) {
    segment.surface = body;
    work->result.decisions.push_back(MakeDecision("merged", segment));
    return;
  }
  const bool held = FindHolder(index, groups_, registry_, *work) > 0;
  const bool large = CountWithDepth(pixels, work->frame.depth) >=
                     (held ? MinFollowedPixels(options_) : options_.min_pixels);
  const bool open = large && (held || !segment.only_held);
  // Who is known, or held by someone, needs no confirmation.
  const int known = open ? FindKnown(segment, pixels, *work) : 0;
  if (known > 0 || (open && (held || IsConfirmed(segment, pixels, *work)))) {
    AddSurface(known, &segment, work);
    return;
  }
  if (segment.only_held) {
    segment.mask.setTo(0);  // Background.
  } else {
    work->unconfirmed |= segment.mask | pixels;
  }
  work->result.decisions.push_back(
      MakeDecision(open ? "pending" : "ignored", segment));
}

bool SurfaceSplitter::IsConfirmed(const Segment& segment,
                                  const cv::Mat_<uchar>& pixels,
                                  const SplitWork& work) {
  const int hits = births_.Add(work.frame.index, segment.mask);
  if (frames_ == 1 && segment.score >= options_.confident_score) return true;
  const cv::Mat mapped =
      pixels & (work.prior.labels == 0) &
      (work.compared.agreement == static_cast<int>(DepthState::kObserved));
  const bool was_background =
      frames_ > kEarlyFrames &&
      2 * cv::countNonZero(mapped) > cv::countNonZero(pixels);
  return hits >= options_.birth_frames * (was_background ? 2 : 1);
}

int SurfaceSplitter::FindKnown(const Segment& segment,
                               const cv::Mat_<uchar>& pixels,
                               const SplitWork& work) const {
  return registry_.FindAlike(
      ComputeAppearance(work.frame.color, work.points, pixels),
      table_.Kind(segment.class_name), registry_.Dormant(), work.frame.index);
}

void SurfaceSplitter::AddSurface(int known, Segment* segment, SplitWork* work) {
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

void SurfaceSplitter::DrawLabels(SplitWork* work) const {
  std::vector<std::uint16_t> id_of(work->segments.size() + 1, 0);
  for (std::size_t i = 0; i < work->segments.size(); ++i) {
    const int id = work->segments[i].surface;
    if (id > 0 && !registry_.at(id).dormant) {
      id_of[i + 1] = static_cast<std::uint16_t>(id);
    }
  }
  work->labels.create(work->segment_labels.size());
  std::transform(work->segment_labels.begin(), work->segment_labels.end(),
                 work->labels.begin(),
                 [&](std::uint16_t segment) { return id_of[segment]; });
  work->result.labels = JoinHeldParts(registry_, work->labels);
}

void SurfaceSplitter::DrawUncertain(SplitWork* work) const {
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

void SurfaceSplitter::Remember(const SplitWork& work) {
  for (const Segment& segment : work.segments) {
    if (segment.surface == 0 || segment.mask.empty()) continue;
    const cv::Mat_<uchar> pixels = work.labels == segment.surface;
    registry_.RecordAppearance(
        segment.surface,
        ComputeAppearance(work.frame.color, work.points, pixels));
    support_.Update(segment.surface, pixels, segment.mask, work.prior.labels);
  }
  last_ = {
      work.labels.clone(), work.frame.depth.clone(), {}, Rigid3d::Identity()};
  last_.depth.setTo(0, work.result.uncertain);
}

}  // namespace splitfusion
