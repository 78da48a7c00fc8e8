#include "splitfusion/lib/split/loose_parts.h"

#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "splitfusion/lib/split/surface_extent.h"

namespace splitfusion {
namespace {

constexpr int kMinPixels = 40;        // Fewer are noise.
constexpr double kMaxShare = 0.5;     // Of the body's pixels: it is a part.
constexpr double kMaxUnmapped = 0.3;  // Of the pixels with depth.
constexpr float kReach = 0.45f;       // Metres: head to chest, hand to hip.
constexpr float kJump = 0.15f;        // Metres between neighbours.
constexpr int kGap = 9;               // Pixels without depth beside an edge.
constexpr double kMaxStrip = 0.06;    // Of the image: width of a strip.
constexpr int kPointStride = 4;       // Pixels between compared points.
/// Of what hides the connection.
constexpr DepthTolerance<float> kInFront = {0.10f, 0};

/// A patch of the image: its pixels (HxW, 255) and the points of some of them.
struct Patch {
  cv::Mat_<uchar> pixels;
  cv::Rect box;
  int count = 0;
  float depth = 0;  // Median, metres.
  std::vector<cv::Vec3f> points;
};

Patch MakePatch(const cv::Mat_<uchar>& pixels, const SplitWork& work) {
  Patch patch;
  patch.pixels = pixels;
  patch.box = cv::boundingRect(pixels);
  std::vector<float> depths;
  for (int v = patch.box.y; v < patch.box.br().y; ++v) {
    for (int u = patch.box.x; u < patch.box.br().x; ++u) {
      const cv::Vec3f& point = work.points.points(v, u);
      if (!pixels(v, u) || !(point[2] > 0)) continue;
      ++patch.count;
      depths.push_back(point[2]);
      if (patch.count % kPointStride == 0) patch.points.push_back(point);
    }
  }
  if (depths.empty()) return patch;
  const auto middle = depths.begin() + depths.size() / 2;
  std::nth_element(depths.begin(), middle, depths.end());
  patch.depth = *middle;
  return patch;
}

/// A box grown by kGap, within the image.
cv::Rect Surroundings(const cv::Rect& box, const cv::Size& image) {
  return cv::Rect(box.x - kGap, box.y - kGap, box.width + 2 * kGap,
                  box.height + 2 * kGap) &
         cv::Rect({0, 0}, image);
}

bool AtBorder(const cv::Rect& box, const cv::Size& image) {
  return box.x < kGap || box.y < kGap || box.br().x > image.width - kGap ||
         box.br().y > image.height - kGap;
}

/// Whether anything that can hide a connection is near.
bool CanBePart(const cv::Rect& box, const SplitWork& work) {
  const cv::Size image = work.segment_labels.size();
  return AtBorder(box, image) ||
         cv::countNonZero(work.segment_labels(Surroundings(box, image))) > 0;
}

/// Segments (1 + index) that lie beside the patch and in front of it.
std::set<int> InFrontOf(const Patch& patch, const SplitWork& work) {
  const cv::Rect area = Surroundings(patch.box, patch.pixels.size());
  cv::Mat_<uchar> grown;
  cv::dilate(patch.pixels(area), grown,
             cv::Mat::ones(2 * kGap + 1, 2 * kGap + 1, CV_8U));
  std::set<int> nearer;
  for (int v = 0; v < area.height; ++v) {
    for (int u = 0; u < area.width; ++u) {
      const int segment = work.segment_labels(area.y + v, area.x + u);
      const float z = work.frame.depth.at<float>(area.y + v, area.x + u);
      if (grown(v, u) && segment > 0 &&
          ClassifyDepth(z, patch.depth, kInFront.At(z)) ==
              DepthState::kOccluded) {
        nearer.insert(segment);
      }
    }
  }
  return nearer;
}

float Distance(const Patch& a, const Patch& b) {
  float least = std::numeric_limits<float>::max();
  for (const cv::Vec3f& p : a.points) {
    for (const cv::Vec3f& q : b.points) {
      const cv::Vec3f d = p - q;
      least = std::min(least, d.dot(d));
    }
  }
  return std::sqrt(least);
}

/// Whether the patch is a mere strip along the border: most of what it is a
/// part of is out of sight.
bool IsStripAtBorder(const Patch& patch) {
  const cv::Size size = patch.pixels.size();
  if (std::min(size.width, size.height) <= 2 * kGap) return true;
  cv::Mat at_border = patch.pixels.clone();
  at_border(cv::Rect(kGap, kGap, size.width - 2 * kGap, size.height - 2 * kGap))
      .setTo(0);
  const double length = cv::countNonZero(at_border) / kGap;
  return patch.count < std::min(length, kMaxStrip * size.width) * length;
}

/// What a piece can belong to.
struct Body {
  int segment = 0;  // 1 + index.
  Patch patch;
  bool strip = false;    // Along the border of the image.
  std::set<int> behind;  // Segments in front of it.
};

bool IsBody(const InstanceRegistry& registry, const Segment& segment) {
  return segment.surface != 0 &&
         registry.at(segment.surface).kind == SurfaceKind::kNonRigid;
}

std::vector<Body> FindBodies(const InstanceRegistry& registry,
                             const SplitWork& work) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < work.segments.size(); ++i) {
    if (!IsBody(registry, work.segments[i])) continue;
    const int index = static_cast<int>(i);
    Body body{index + 1,
              MakePatch(SegmentPixels(index, work.segment_labels), work),
              false,
              {}};
    if (body.patch.points.empty()) continue;
    body.strip = IsStripAtBorder(body.patch);
    body.behind = InFrontOf(body.patch, work);
    bodies.push_back(std::move(body));
  }
  return bodies;
}

/// Whether what connects piece and body can be out of sight.
bool CanBeConnected(bool at_border, const std::set<int>& behind,
                    const Body& body) {
  if (at_border && body.strip) return true;
  return std::any_of(behind.begin(), behind.end(), [&](int segment) {
    return segment != body.segment && body.behind.count(segment) > 0;
  });
}

/// Segment (1 + index) that the piece is given to, 0 = none.
int FindOwner(const Patch& piece, const std::vector<Body>& bodies,
              const SplitWork& work) {
  const bool at_border = AtBorder(piece.box, piece.pixels.size());
  const std::set<int> behind = InFrontOf(piece, work);
  int owner = 0;
  float least = kReach;
  for (const Body& body : bodies) {
    if (piece.count > kMaxShare * body.patch.count ||
        !CanBeConnected(at_border, behind, body)) {
      continue;
    }
    const float distance = Distance(piece, body.patch);
    if (distance >= least) continue;
    least = distance;
    owner = body.segment;
  }
  return owner;
}

/// Whether most of the room in view is mapped: else anything may be new.
bool IsMapped(const SplitWork& work) {
  const cv::Mat measured = work.frame.depth > 0;
  return cv::countNonZero(UnmappedPixels(work.compared) & measured) <
         kMaxUnmapped * cv::countNonZero(measured);
}

/// Whether the depth jumps between a pixel and its neighbours.
cv::Mat_<uchar> DepthJumps(const cv::Mat_<float>& depth) {
  cv::Mat_<float> far, near, known = depth.clone();
  cv::dilate(depth, far, cv::Mat::ones(3, 3, CV_8U));
  known.setTo(std::numeric_limits<float>::max(), depth <= 0);
  cv::erode(known, near, cv::Mat::ones(3, 3, CV_8U));
  return far - near > kJump;
}

/// Pixels without a claim; of these `open` those that no background is known to
/// explain.
struct Unclaimed {
  cv::Mat_<uchar> free;
  cv::Mat_<uchar> open;
};

Unclaimed FindUnclaimed(const SplitWork& work) {
  const cv::Mat& depth = work.frame.depth;
  Unclaimed found;
  found.free = (work.segment_labels == 0) & ~work.unconfirmed &
               ~MasksBut(-1, work.segments, depth.size());
  found.open = (UnexplainedPixels(0, work.compared) |
                (UnmappedPixels(work.compared) & (depth > 0))) &
               found.free;
  return found;
}

/// The open pixels, cut where the depth jumps, with holes in the depth closed,
/// and without single ones.
cv::Mat_<uchar> Pieces(const Unclaimed& unclaimed, const cv::Mat& depth) {
  const cv::Mat smooth = unclaimed.open & ~DepthJumps(depth);
  cv::Mat closed, cleaned;
  cv::morphologyEx(smooth, closed, cv::MORPH_CLOSE, cv::Mat::ones(5, 5, CV_8U));
  closed &= smooth | (unclaimed.free & (depth == 0));
  cv::morphologyEx(closed, cleaned, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  return cleaned;
}

/// The piece with the rim that was cut off at jumps of the depth.
cv::Mat_<uchar> WithRim(const cv::Mat_<uchar>& piece,
                        const cv::Mat_<uchar>& open) {
  cv::Mat_<uchar> grown;
  cv::dilate(piece, grown, cv::Mat::ones(3, 3, CV_8U));
  return piece | (grown & open);
}

/// Whether the piece does not hang together with the mapped background.
bool StandsFree(const Patch& piece, const SplitWork& work) {
  const cv::Mat_<uchar> mapped =
      (work.compared.background == static_cast<int>(DepthState::kObserved)) &
      (work.segment_labels == 0);
  const cv::Mat_<uchar> grown =
      GrowOver(mapped, piece.pixels, work.frame.depth);
  return cv::countNonZero(grown) - cv::countNonZero(piece.pixels) < kMinPixels;
}

}  // namespace

void ClaimLooseParts(const InstanceRegistry& registry, SplitWork* work) {
  const bool has_bodies = std::any_of(
      work->segments.begin(), work->segments.end(),
      [&](const Segment& segment) { return IsBody(registry, segment); });
  if (!has_bodies || !IsMapped(*work)) return;
  const Unclaimed unclaimed = FindUnclaimed(*work);
  cv::Mat_<int> pieces;
  cv::Mat stats, centroids;
  const int count = cv::connectedComponentsWithStats(
      Pieces(unclaimed, work->frame.depth), pieces, stats, centroids);
  std::vector<Body> bodies;
  for (int i = 1; i < count; ++i) {
    const cv::Rect box(stats.at<int>(i, cv::CC_STAT_LEFT),
                       stats.at<int>(i, cv::CC_STAT_TOP),
                       stats.at<int>(i, cv::CC_STAT_WIDTH),
                       stats.at<int>(i, cv::CC_STAT_HEIGHT));
    if (stats.at<int>(i, cv::CC_STAT_AREA) < kMinPixels ||
        !CanBePart(box, *work)) {
      continue;
    }
    if (bodies.empty()) bodies = FindBodies(registry, *work);
    if (bodies.empty()) return;
    const Patch piece = MakePatch(pieces == i, *work);
    const int owner = FindOwner(piece, bodies, *work);
    if (owner > 0 && StandsFree(piece, *work)) {
      work->segment_labels.setTo(static_cast<std::uint16_t>(owner),
                                 WithRim(piece.pixels, unclaimed.open));
    }
  }
}

}  // namespace splitfusion
