#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "splitfusion/pipelines/split_fusion.h"
#include "support/expect_input_error.h"
#include "support/repository.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace {

void ExpectRefused(const std::function<void(PipelineOptions*)>& set,
                   const std::string& message) {
  PipelineOptions options;
  set(&options);
  ExpectInputError(
      [&] { SplitFusion(SmallCamera(), options, LabelTable(), nullptr); },
      message);
}

TEST(PipelineOptions, DefaultsPass) {
  EXPECT_NO_THROW(PipelineOptions().Check());
}

TEST(PipelineOptions, RefuseValuesOutOfRange) {
  ExpectRefused([](PipelineOptions* o) { o->render_stride = 0; },
                "render_stride = 0: expected 1..8 pixels");
  ExpectRefused([](PipelineOptions* o) { o->render_stride = 3; },
                "render_stride = 3: expected a divisor of the stride of every "
                "tracking stage (8)");
  ExpectRefused([](PipelineOptions* o) { o->min_birth_area = 1; },
                "min_birth_area = 1: expected 0..1 of the image, not 1");
  ExpectRefused([](PipelineOptions* o) { o->max_lost = 0; },
                "max_lost = 0: expected frames >= 1");
  ExpectRefused([](PipelineOptions* o) { o->min_tracked_pixels = 0; },
                "min_tracked_pixels = 0: expected pixels >= 1");
}

TEST(PipelineOptions, ThoseOfAllPartsAreChecked) {
  ExpectRefused([](PipelineOptions* o) { o->terms = "no_such_term"; },
                "term = no_such_term: expected point_to_plane");
  ExpectRefused([](PipelineOptions* o) { o->object.tsdf.voxel_size = 0; },
                "object_voxel = 0");
  ExpectRefused([](PipelineOptions* o) { o->graph.max_nodes = 0; },
                "max_nodes = 0");
  ExpectRefused([](PipelineOptions* o) { o->solver.threads = 0; },
                "solver_threads = 0");
  ExpectRefused([](PipelineOptions* o) { o->ray_cast.min_depth = 0; },
                "ray_min_depth = 0");
  ExpectRefused([](PipelineOptions* o) { o->tracker.prior_anneal = 0; },
                "prior_anneal = 0");
  ExpectRefused([](PipelineOptions* o) { o->split.min_score = 2; },
                "min_score = 2");
}

TEST(PipelineOptions, ThePaperMapStatesTheDefaultEnergy) {
  std::ifstream stream(RepositoryRoot() / "docs/paper_map.md");
  const std::string map{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(map.find("`" + PipelineOptions().terms + "`"), std::string::npos)
      << "docs/paper_map.md lacks `" << PipelineOptions().terms << "`";
}

TEST(PipelineOptions, CamerasAreCheckedToo) {
  PinholeCamera camera = SmallCamera();
  camera.fx = 0;
  ExpectInputError(
      [&] { SplitFusion(camera, PipelineOptions(), LabelTable(), nullptr); },
      "fx");
}

}  // namespace
}  // namespace splitfusion
