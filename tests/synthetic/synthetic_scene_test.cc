#include "splitfusion/lib/synthetic/synthetic_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

SyntheticOptions SmallOptions() {
  SyntheticOptions options;
  options.width = 160;
  options.height = 120;
  options.frames = 600;
  options.track_points = 200;
  return options;
}

const SyntheticScene& Scene() {
  static const SyntheticScene* const scene = new SyntheticScene(SmallOptions());
  return *scene;
}

/// Depth between pixel centres; negative where the four pixels do not all show
/// the instance or are not on one smooth surface.
float InterpolatedDepth(const SyntheticFrame& frame, int instance, float u,
                        float v) {
  const int u0 = static_cast<int>(std::floor(u));
  const int v0 = static_cast<int>(std::floor(v));
  if (u0 < 0 || v0 < 0 || u0 + 1 >= frame.labels.cols ||
      v0 + 1 >= frame.labels.rows) {
    return -1;
  }
  float inverse = 0, low = 1e9f, high = 0;
  for (int k = 0; k < 4; ++k) {
    const int du = k % 2, dv = k / 2;
    if (frame.labels.at<unsigned char>(v0 + dv, u0 + du) != instance) {
      return -1;
    }
    const float depth = frame.true_depth.at<float>(v0 + dv, u0 + du);
    low = std::min(low, depth);
    high = std::max(high, depth);
    // Inverse depth is linear over a planar patch.
    inverse += (du ? u - u0 : 1 - u + u0) * (dv ? v - v0 : 1 - v + v0) / depth;
  }
  return high - low < 0.01f ? 1 / inverse : -1;
}

TEST(SyntheticScene, SameOptionsSamePixelsInAnyOrder) {
  const SyntheticScene other(SmallOptions());
  other.Render(40);
  const SyntheticFrame a = Scene().Render(7), b = other.Render(7);
  EXPECT_EQ(cv::norm(a.frame.color, b.frame.color, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(a.frame.depth, b.frame.depth, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(a.true_depth, b.true_depth, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(a.labels, b.labels, cv::NORM_INF), 0);
  EXPECT_TRUE(a.world_from_camera.isApprox(b.world_from_camera, 0));
}

TEST(SyntheticScene, TheSeedChangesTexturesAndNoiseButNotTheBodies) {
  SyntheticOptions options = SmallOptions();
  options.seed = 2;
  const SyntheticScene other(options);
  EXPECT_GT(cv::norm(Scene().Render(0).frame.color, other.Render(0).frame.color,
                     cv::NORM_INF),
            30);
  EXPECT_EQ(Scene().PosedMesh(kPersonId, 3).vertices,
            other.PosedMesh(kPersonId, 3).vertices);
}

TEST(SyntheticScene, FrameHasTheTypesOfTheInterface) {
  const SyntheticFrame rendered = Scene().Render(1);
  EXPECT_EQ(rendered.frame.color.type(), CV_8UC3);
  EXPECT_EQ(rendered.frame.depth.type(), CV_32FC1);
  EXPECT_EQ(rendered.true_depth.type(), CV_32FC1);
  EXPECT_EQ(rendered.labels.type(), CV_8UC1);
  EXPECT_EQ(rendered.frame.index, 1);
  EXPECT_NEAR(rendered.frame.timestamp - Scene().Timestamp(0), 1 / 30.0, 1e-6);
  EXPECT_EQ(rendered.frame.stem, Scene().Stem(1));
  EXPECT_EQ(rendered.frame.color.size(), cv::Size(160, 120));
}

TEST(SyntheticScene, EveryDirectionIsSeenWithinTheRange) {
  const SyntheticFrame rendered = Scene().Render(0);
  EXPECT_EQ(cv::countNonZero(rendered.true_depth), 160 * 120);
  EXPECT_GT(cv::countNonZero(rendered.frame.depth), 0.85 * 160 * 120);
}

TEST(SyntheticScene, WithoutNoiseDepthIsExact) {
  SyntheticOptions options = SmallOptions();
  options.noise = false;
  const SyntheticFrame rendered = SyntheticScene(options).Render(0);
  EXPECT_EQ(cv::norm(rendered.frame.depth, rendered.true_depth, cv::NORM_INF),
            0);
}

TEST(SyntheticScene, PersonToyAndChairAreInTheFirstFrames) {
  for (const int frame : {0, 30, 60, 89}) {
    const SyntheticFrame rendered = Scene().Render(frame);
    EXPECT_GT(cv::countNonZero(rendered.labels == kPersonId), 1000) << frame;
    EXPECT_GT(cv::countNonZero(rendered.labels == kSoftObjectId), 200) << frame;
    EXPECT_GT(cv::countNonZero(rendered.labels == kChairId), 20) << frame;
  }
}

TEST(SyntheticScene, StaticPixelsLieOnTheSolids) {
  const SyntheticFrame rendered = Scene().Render(25);
  const PinholeCamera& camera = Scene().camera();
  for (int v = 0; v < camera.height; v += 7) {
    for (int u = 0; u < camera.width; u += 7) {
      const int label = rendered.labels.at<unsigned char>(v, u);
      if (label == kPersonId || label == kSoftObjectId) continue;
      const Vector3f point = (rendered.world_from_camera *
                              camera.BackProject<double>(
                                  u, v, rendered.true_depth.at<float>(v, u)))
                                 .cast<float>();
      bool on_surface = false;
      for (const Solid& solid : Scene().solids()) {
        Solid grown = solid, shrunk = solid;
        grown.half_size += Vector3f::Constant(2e-3f);
        // Round shapes are polygons: their flats lie a little inside.
        const float margin = solid.shape == SolidShape::kBox ? 2e-3f : 0.02f;
        shrunk.half_size -= Vector3f::Constant(margin);
        shrunk.half_size = shrunk.half_size.cwiseMax(1e-6f);
        on_surface |= Contains(grown, point) && !Contains(shrunk, point);
      }
      EXPECT_TRUE(on_surface) << u << ' ' << v << ": " << point.transpose();
    }
  }
}

TEST(SyntheticScene, VisibleTracksLieOnTheTrueDepth) {
  SyntheticOptions options = SmallOptions();
  options.width = 640;
  options.height = 480;
  options.track_points = 500;
  const SyntheticScene scene(options);
  const SyntheticFrame rendered = scene.Render(50);
  const std::vector<Vector3f> world = scene.TrackPositions(50);
  const std::vector<bool> visible = scene.TrackVisibility(rendered);
  const Rigid3f camera_from_world =
      rendered.world_from_camera.inverse().cast<float>();
  int compared = 0, near = 0, seen = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (!visible[i]) continue;
    ++seen;
    const Vector3f point = camera_from_world * world[i];
    const Eigen::Vector2f pixel = scene.camera().Project(point);
    const float depth = InterpolatedDepth(
        rendered, scene.track_points()[i].instance, pixel.x(), pixel.y());
    if (depth < 0) continue;
    ++compared;
    near += std::abs(depth - point.z()) < 1e-3f;
  }
  EXPECT_GT(seen, 0.3 * world.size());
  EXPECT_LT(seen, 0.6 * world.size());  // About half of a body is behind.
  EXPECT_GT(compared, 100);
  EXPECT_GE(near, 0.97 * compared);
}

TEST(SyntheticScene, TracksAreSpreadOverBothDeformingInstances) {
  int person = 0, toy = 0;
  for (const ScenePoint& point : Scene().track_points()) {
    person += point.instance == kPersonId;
    toy += point.instance == kSoftObjectId;
    EXPECT_GE(point.b1, 0);
    EXPECT_GE(point.b2, 0);
    EXPECT_LE(point.b1 + point.b2, 1);
  }
  EXPECT_EQ(person, 200);
  EXPECT_EQ(toy, 200);
}

TEST(SyntheticScene, TracksStickToTheirTriangles) {
  for (const int frame : {0, 31}) {
    const auto positions = Scene().TrackPositions(frame);
    const TriangleMesh mesh = Scene().PosedMesh(kPersonId, frame);
    const ScenePoint& p = Scene().track_points().front();
    ASSERT_EQ(p.instance, kPersonId);
    const Eigen::Vector3i& t = mesh.triangles[p.triangle];
    const Vector3f expected = (1 - p.b1 - p.b2) * mesh.vertices[t[0]] +
                              p.b1 * mesh.vertices[t[1]] +
                              p.b2 * mesh.vertices[t[2]];
    EXPECT_LT((positions.front() - expected).norm(), 1e-6f);
  }
}

TEST(SyntheticScene, PersonNeverEntersFurnitureFloorOrToy) {
  for (int frame = 0; frame < 600; frame += 10) {
    const TriangleMesh person = Scene().PosedMesh(kPersonId, frame);
    const TriangleMesh toy = Scene().PosedMesh(kSoftObjectId, frame);
    Solid toy_ball;
    toy_ball.shape = SolidShape::kSphere;
    toy_ball.center = RoomTableTop() + Vector3f(0, 0, 0.2f);
    toy_ball.half_size = Vector3f(0.22f, 0.22f, 0.3f);
    for (std::size_t i = 0; i < Scene().solids().size(); ++i) {
      const Solid& solid = Scene().solids()[i];
      int hits = 0;
      for (const Vector3f& vertex : person.vertices) {
        hits += Contains(solid, vertex) != solid.inside_out;
        hits += Contains(toy_ball, vertex);
      }
      for (const Vector3f& vertex : toy.vertices) {
        hits += Contains(solid, vertex) != solid.inside_out;
      }
      EXPECT_EQ(hits, 0) << "frame " << frame << ", solid " << i;
    }
  }
}

TEST(SyntheticScene, SubjectSpeedZeroHoldsEveryoneStill) {
  SyntheticOptions options = SmallOptions();
  options.subject_speed = 0;
  const SyntheticScene scene(options);
  EXPECT_EQ(scene.TrackPositions(0), scene.TrackPositions(45));
  EXPECT_NE(Scene().TrackPositions(0), Scene().TrackPositions(45));
}

TEST(SyntheticScene, ExactMasksAreTheLabels) {
  SyntheticOptions options = SmallOptions();
  options.exact_masks = true;
  const SyntheticScene scene(options);
  const SyntheticFrame rendered = scene.Render(0);
  const auto detections = scene.Detections(rendered);
  ASSERT_EQ(detections.size(), 3u);
  cv::Mat all = cv::Mat::zeros(120, 160, CV_8UC1);
  for (const InstanceMask& detection : detections) all |= detection.mask;
  EXPECT_EQ(cv::countNonZero(all != (rendered.labels > 0)), 0);
}

TEST(SyntheticScene, EveryKindShowsItsInstances) {
  const auto ids = [](SyntheticSceneKind kind) {
    SyntheticOptions options = SmallOptions();
    options.scene = kind;
    const SyntheticScene scene(options);
    const SyntheticFrame rendered = scene.Render(0);
    EXPECT_GT(cv::countNonZero(rendered.frame.depth), 500);
    std::set<int> found;
    for (const SyntheticInstance& instance : scene.instances()) {
      if (cv::countNonZero(rendered.labels == instance.id) > 0) {
        found.insert(instance.id);
      }
    }
    EXPECT_EQ(found.size(), scene.instances().size());
    return found;
  };
  EXPECT_EQ(ids(SyntheticSceneKind::kRoom), (std::set<int>{kChairId}));
  EXPECT_EQ(ids(SyntheticSceneKind::kPerson), (std::set<int>{kPersonId}));
  EXPECT_EQ(ids(SyntheticSceneKind::kSoftObject),
            (std::set<int>{kSoftObjectId}));
}

TEST(SyntheticScene, RejectsFramesAndInstancesThatAreNotThere) {
  ExpectInputError([] { Scene().Render(600); },
                   "frame = 600: expected 0 to 599");
  ExpectInputError([] { Scene().Render(-1); }, "frame = -1");
  ExpectInputError([] { Scene().PosedMesh(kChairId, 0); },
                   "instance = 3: expected a moving instance");
  SyntheticOptions options = SmallOptions();
  options.frames = 0;
  ExpectInputError([&] { SyntheticScene scene(options); }, "frames = 0");
}

}  // namespace
}  // namespace splitfusion
