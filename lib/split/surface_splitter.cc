#include "splitfusion/lib/split/surface_splitter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/split/held_parts.h"
#include "splitfusion/lib/split/surface_contact.h"
#include "splitfusion/lib/split/surface_extent.h"

namespace splitfusion {
namespace {

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

bool IsTrackable(SurfaceKind kind, const SplitOptions& options) {
  return options.rigid_objects == "separate" || kind == SurfaceKind::kNonRigid;
}

bool IsTrusted(const InstanceMask& detection, SurfaceKind kind,
               const SplitOptions& options) {
  const double area =
      double(cv::countNonZero(detection.mask)) / detection.mask.total();
  return detection.score >= options.min_score && area <= options.max_area &&
         IsTrackable(kind, options);
}

/// Whether most of what is background by the prior, outside of detections, is
/// where it was mapped; true if nothing is known of it.
bool BackgroundFits(const std::vector<Candidate>& candidates,
                    const ComparedDepth& compared) {
  cv::Mat_<uchar> open = compared.labels == 0;
  for (const Candidate& candidate : candidates) open.setTo(0, candidate.mask);
  const cv::Mat_<uchar>& agreement = compared.agreement;
  open.setTo(0, agreement == static_cast<int>(DepthState::kUnmeasured));
  const int same = cv::countNonZero(
      open & (agreement == static_cast<int>(DepthState::kObserved)));
  return same >= kMinFit * cv::countNonZero(open);
}

/// Whether more than half of a mask's pixels are among those of `pixels`.
bool IsMostlyOn(const cv::Mat_<uchar>& pixels, const cv::Mat_<uchar>& mask) {
  return 2 * cv::countNonZero(pixels & mask) > cv::countNonZero(mask);
}

Segment MakeSegment(const Candidate& candidate, const Match& match) {
  Segment segment;
  segment.surface = match.surface;
  segment.tentative = match.tentative;
  segment.mask = candidate.mask.clone();
  segment.class_name = candidate.class_name;
  segment.score = candidate.score;
  segment.iou = match.iou;
  segment.appearance = candidate.appearance;
  return segment;
}

/// Surface that a newcomer is a part of: one of its class that it touches along
/// a share of `min_contact` of its border; 0 if none.
int FindBody(int index, const std::vector<Segment>& segments,
             const LabelImage& segment_labels, const PointMap& points,
             const TrackTable& tracks, double min_contact) {
  if (segments[index].appearance.identity > 0) return 0;
  const cv::Mat_<uchar> pixels = SegmentPixels(index, segment_labels);
  int body = 0;
  double best = min_contact;
  for (int i = 0; i < static_cast<int>(segments.size()); ++i) {
    const int id = segments[i].surface;
    if (i == index || id == 0 ||
        tracks.at(id).class_name != segments[index].class_name) {
      continue;
    }
    const double share =
        ContactShare(points, pixels, SegmentPixels(i, segment_labels));
    if (share < best) continue;
    best = share;
    body = id;
  }
  return body;
}

}  // namespace

SurfaceSplitter::SurfaceSplitter(const PinholeCamera& camera, LabelTable table,
                                 SplitOptions options)
    : camera_(camera),
      table_(std::move(table)),
      options_(std::move(options)),
      groups_(ParseMergeGroups(options_.merge_touching)),
      objects_(camera, options_) {
  camera_.Check();
  options_.Check();
}

SplitResult SurfaceSplitter::Split(const Frame& frame, const PointMap& points,
                                   const std::vector<InstanceMask>& detections,
                                   const SurfacePrediction& prediction) {
  CheckSizes(frame, detections, prediction);
  ++frames_;
  last_frame_ = frame.index;
  SurfacePrediction prior = CompletePrediction(
      prediction, last_, Followed(tracks_), {camera_.width, camera_.height});
  ComparedDepth compared =
      CompareDepth(frame.depth, camera_.noise, prior, options_.prior);
  SplitResult result;
  const Input input{frame, points, prior, compared};
  const JoinedDetections joined = JoinHeldParts(detections, groups_, points);
  EndHeldTracks(joined.held, groups_, &tracks_, &compared);
  std::vector<Candidate> candidates = MakeCandidates(joined.detections, input);
  cv::Mat_<uchar> unconfirmed = WatchObjects(input, &candidates);
  std::vector<Match> matches =
      AssignDetections(candidates,
                       {tracks_, tentative_.all(), compared.labels,
                        compared.agreement, frame.index},
                       options_.assignment);
  FollowMoving(matches, &candidates, &unconfirmed);
  RecognizeReturned(frame.index, &compared.labels, &matches, &result.decisions);
  TakeOutParts(groups_, candidates, tracks_, &compared, &matches);
  TakeOutOthers(candidates, tracks_, &compared);
  std::vector<Segment> segments = MakeSegments(candidates, matches, frame.index,
                                               &unconfirmed, &result.decisions);
  AddMissedSurfaces(&segments);
  CutSegments(input, &segments);
  const LabelImage segment_labels = ComposeSegments(
      segments, compared.labels, frame.depth, options_.min_island);
  SettleSurfaces(segments, input, &result.decisions);
  for (int i = 0; i < static_cast<int>(segments.size()); ++i) {
    if (segments[i].surface > 0) continue;
    SettleNewcomer(i, input, segment_labels, &segments, &unconfirmed,
                   &result.decisions);
  }
  tentative_.EndFrame(frame.index);
  result.standing = StandingObjects(candidates, matches);
  result.labels = DrawLabels(segments, segment_labels);
  result.uncertain = DrawUncertain(segments, result.labels, unconfirmed, input);
  Remember(segments, result, input);
  return result;
}

void SurfaceSplitter::BelieveMoving(const StandingObject& object) {
  tentative_.AddMoving(object.mask, object.appearance, last_frame_,
                       2 * options_.birth_frames);
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

std::vector<Candidate> SurfaceSplitter::MakeCandidates(
    const std::vector<InstanceMask>& detections, const Input& input) const {
  std::vector<Candidate> candidates;
  for (const InstanceMask& detection : detections) {
    const SurfaceKind kind = table_.Kind(detection.class_name);
    candidates.push_back(
        {detection.mask, detection.class_name, detection.score, kind,
         IsTrusted(detection, kind, options_), false,
         ComputeAppearance(input.frame.color, input.points, detection.mask,
                           input.prior.world_from_camera)});
    candidates.back().appearance.identity = detection.identity;
  }
  return candidates;
}

cv::Mat_<uchar> SurfaceSplitter::WatchObjects(
    const Input& input, std::vector<Candidate>* candidates) {
  cv::Mat_<uchar> claimed(input.frame.depth.size(), uchar(0));
  if (!BackgroundFits(*candidates, input.compared)) return claimed;
  for (const Candidate& candidate : *candidates) {
    if (candidate.score >= options_.min_score &&
        candidate.kind == SurfaceKind::kNonRigid) {
      claimed |= candidate.mask;
    }
  }
  for (const int id : Followed(tracks_)) {
    if (tracks_.at(id).kind == SurfaceKind::kRigid) continue;
    claimed |= input.compared.labels == id;
  }
  const cv::Mat_<uchar> in_front =
      input.compared.background == static_cast<int>(DepthState::kOccluded);
  for (Candidate& candidate : *candidates) {
    candidate.apart = objects_.IsWatched(candidate) &&
                      IsMostlyOn(in_front | (input.compared.labels > 0),
                                 candidate.mask & (input.frame.depth > 0));
  }
  return objects_.Watch({input.frame.index, input.frame.depth, input.points,
                         input.prior.world_from_camera, claimed, in_front},
                        candidates);
}

void SurfaceSplitter::FollowMoving(const std::vector<Match>& matches,
                                   std::vector<Candidate>* candidates,
                                   cv::Mat_<uchar>* unconfirmed) const {
  for (const TentativeTrack& track : tentative_.all()) {
    if (track.moves) *unconfirmed |= track.mask;
  }
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const int index = matches[i].tentative;
    if (index >= 0 && tentative_.all()[index].moves) {
      (*candidates)[i].moved = true;
    }
  }
}

std::vector<StandingObject> SurfaceSplitter::StandingObjects(
    const std::vector<Candidate>& candidates,
    const std::vector<Match>& matches) const {
  std::vector<StandingObject> standing;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (matches[i].surface > 0 || candidate.moved ||
        !objects_.IsWatched(candidate)) {
      continue;
    }
    standing.push_back({candidate.mask, candidate.class_name, candidate.score,
                        candidate.appearance});
  }
  return standing;
}

void SurfaceSplitter::RecognizeReturned(int frame, LabelImage* predicted,
                                        std::vector<Match>* matches,
                                        std::vector<SplitDecision>* decisions) {
  for (Match& match : *matches) {
    if (match.surface == 0 || match.piece) continue;
    Track& track = tracks_.at(match.surface);
    const int returned = track.followed() ? FindReturned(track, tracks_, frame,
                                                         options_.assignment)
                                          : 0;
    if (returned == 0) continue;
    track.merged_into = returned;
    track.Apply(TrackEvent::kGone);
    SplitDecision decision{"merged", track.id, track.class_name, 0, match.iou};
    decisions->push_back(decision);
    predicted->setTo(returned, *predicted == track.id);
    for (Match& other : *matches) {
      if (other.surface == track.id) other.surface = returned;
    }
  }
}

std::vector<Segment> SurfaceSplitter::MakeSegments(
    const std::vector<Candidate>& candidates, const std::vector<Match>& matches,
    int frame, cv::Mat_<uchar>* unconfirmed,
    std::vector<SplitDecision>* decisions) {
  std::vector<Segment> segments;
  std::map<int, std::size_t> segment_of;  // By surface.
  const auto add = [&](const Candidate& candidate, const Match& match) {
    const Segment segment = MakeSegment(candidate, match);
    const auto known = segment_of.find(match.surface);
    if (match.surface > 0 && known != segment_of.end()) {
      segments[known->second].mask |= candidate.mask;
      decisions->push_back(MakeDecision("merged", segment));
    } else if (match.surface > 0 || candidate.trusted || candidate.moved) {
      if (match.surface > 0) segment_of[match.surface] = segments.size();
      segments.push_back(segment);
    } else {
      decisions->push_back(MakeDecision("ignored", segment));
      if (IsTrackable(candidate.kind, options_)) *unconfirmed |= candidate.mask;
      if (match.tentative >= 0) {
        tentative_.Record(match.tentative, frame, candidate.mask,
                          candidate.appearance, /*counts=*/false);
      }
    }
  };
  // Pieces last, so that a segment begins with its main detection.
  for (const bool piece : {false, true}) {
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (matches[i].piece == piece) add(candidates[i], matches[i]);
    }
  }
  return segments;
}

void SurfaceSplitter::AddMissedSurfaces(std::vector<Segment>* segments) const {
  std::set<int> missed = Followed(tracks_);
  for (const Segment& segment : *segments) missed.erase(segment.surface);
  for (const int id : missed) {
    Segment segment;
    segment.surface = id;
    segment.class_name = tracks_.at(id).class_name;
    segments->push_back(segment);
  }
}

void SurfaceSplitter::CutSegments(const Input& input,
                                  std::vector<Segment>* segments) const {
  tbb::parallel_for(std::size_t{0}, segments->size(), [&](std::size_t i) {
    Segment& segment = (*segments)[i];
    SurfaceObservation observation{
        segment.surface,
        segment.mask,
        MasksBut(static_cast<int>(i), *segments, input.frame.depth.size()),
        {}};
    if (segment.mask.empty()) {
      observation.extent = MissedExtent(segment.surface, observation.others,
                                        input.compared, input.frame.depth);
    }
    segment.evidence = GatherEvidence(observation, input.compared,
                                      options_.graph_cut, options_.prior);
    if (segment.evidence.crop.area() == 0) return;
    segment.foreground =
        CutForeground(input.points, input.frame.color, segment.evidence.crop,
                      segment.evidence.evidence, options_.graph_cut);
  });
}

void SurfaceSplitter::SettleSurfaces(const std::vector<Segment>& segments,
                                     const Input& input,
                                     std::vector<SplitDecision>* decisions) {
  for (const Segment& segment : segments) {
    if (segment.surface == 0) continue;
    Track& track = tracks_.at(segment.surface);
    if (!segment.mask.empty()) {
      decisions->push_back(
          MakeDecision(track.followed() ? "matched" : "revived", segment));
      track.Detect(input.frame.index, segment.class_name, segment.score);
      continue;
    }
    const int missed = input.frame.index - track.last_detected_frame;
    if (missed > options_.max_missed_frames) {
      track.Apply(TrackEvent::kGone);
    }
    decisions->push_back(
        MakeDecision(track.followed() ? "missed" : "inactive", segment));
  }
}

void SurfaceSplitter::SettleNewcomer(int index, const Input& input,
                                     const LabelImage& segment_labels,
                                     std::vector<Segment>* segments,
                                     cv::Mat_<uchar>* unconfirmed,
                                     std::vector<SplitDecision>* decisions) {
  Segment& segment = (*segments)[index];
  segment.surface = FindBody(index, *segments, segment_labels, input.points,
                             tracks_, options_.min_contact);
  if (segment.surface > 0) {
    decisions->push_back(MakeDecision("merged", segment));
    return;
  }
  const cv::Mat_<uchar> pixels = SegmentPixels(index, segment_labels);
  const bool large =
      cv::countNonZero(pixels & (input.frame.depth > 0)) >= options_.min_pixels;
  if (!large || !IsConfirmed(segment, pixels, input)) {
    *unconfirmed |= segment.mask | pixels;
    decisions->push_back(MakeDecision(large ? "pending" : "ignored", segment));
    return;
  }
  segment.surface = AddTrack(input.frame.index, segment.class_name,
                             table_.Kind(segment.class_name), &tracks_);
  tracks_.at(segment.surface)
      .Detect(input.frame.index, segment.class_name, segment.score);
  decisions->push_back(MakeDecision("born", segment));
}

bool SurfaceSplitter::IsConfirmed(const Segment& segment,
                                  const cv::Mat_<uchar>& pixels,
                                  const Input& input) {
  const int index =
      tentative_.Record(segment.tentative, input.frame.index, segment.mask,
                        segment.appearance, /*counts=*/true);
  const cv::Mat mapped =
      pixels & (input.compared.labels == 0) &
      (input.compared.agreement == static_cast<int>(DepthState::kObserved));
  // Twice as much against what is known: that it is of a rigid class, or stands
  // where background has been mapped for longer than detectors miss a thing.
  const bool known = !IsTrackable(table_.Kind(segment.class_name), options_) ||
                     (frames_ > options_.max_missed_frames &&
                      2 * cv::countNonZero(mapped) > cv::countNonZero(pixels));
  const double needed = (known ? 2 : 1) * options_.birth_frames;
  const bool at_once =
      frames_ == 1 && segment.score >= options_.confident_score;
  if (!at_once && tentative_.all()[index].evidence < needed) return false;
  tentative_.Confirm(index);
  return true;
}

LabelImage SurfaceSplitter::DrawLabels(const std::vector<Segment>& segments,
                                       const LabelImage& segment_labels) const {
  std::vector<std::uint16_t> id_of(segments.size() + 1, 0);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const int id = segments[i].surface;
    if (id > 0 && tracks_.at(id).followed()) {
      id_of[i + 1] = static_cast<std::uint16_t>(id);
    }
  }
  LabelImage labels(segment_labels.size());
  std::transform(segment_labels.begin(), segment_labels.end(), labels.begin(),
                 [&](std::uint16_t segment) { return id_of[segment]; });
  return labels;
}

cv::Mat SurfaceSplitter::DrawUncertain(const std::vector<Segment>& segments,
                                       const LabelImage& labels,
                                       const cv::Mat_<uchar>& unconfirmed,
                                       const Input& input) const {
  const cv::Mat_<uchar>& agreement = input.compared.agreement;
  cv::Mat_<uchar> expected(labels.size(), uchar(0));
  for (const int id : Followed(tracks_)) {
    expected |= input.compared.labels == id;
  }
  cv::Mat_<uchar> missed(labels.size(), uchar(0));
  for (const Segment& segment : segments) {
    if (segment.mask.empty()) missed |= labels == segment.surface;
  }
  const cv::Mat background_seen =
      (input.compared.labels == 0) &
      (agreement == static_cast<int>(DepthState::kObserved));
  cv::Mat near;
  const int size = 2 * options_.uncertain_band + 1;
  cv::dilate(
      (labels > 0) | unconfirmed, near,
      cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(size, size)));
  const cv::Mat uncertain =
      near | Protrusions(labels, missed, input.compared, input.frame.depth) |
      (MasksBut(-1, segments, labels.size()) & ~background_seen) |
      (expected & (agreement != static_cast<int>(DepthState::kFree)));
  return uncertain & (labels == 0);
}

void SurfaceSplitter::Remember(const std::vector<Segment>& segments,
                               const SplitResult& result, const Input& input) {
  for (const Segment& segment : segments) {
    if (segment.surface == 0 || segment.mask.empty()) continue;
    Appearance view = ComputeAppearance(input.frame.color, input.points,
                                        result.labels == segment.surface,
                                        input.prior.world_from_camera);
    view.identity = segment.appearance.identity;
    AddView(view, &tracks_.at(segment.surface).appearance);
  }
  last_ = {result.labels.clone(),
           input.frame.depth.clone(),
           {},
           Rigid3d::Identity()};
  last_.depth.setTo(0, result.uncertain);
}

}  // namespace splitfusion
