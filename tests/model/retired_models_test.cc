#include "splitfusion/lib/model/retired_models.h"

#include <gtest/gtest.h>

#include <memory>
#include <sstream>

#include "splitfusion/lib/base/archive.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

RetiredModels OneAndTwo() {
  auto file = std::make_shared<SpoolFile>();
  RetiredModels models(file);
  for (const int number : {1, 2}) {
    DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
    graph.motions[0].translation.x() = number;
    MotionLog history(file);
    for (int frame = 0; frame < 3 * number; ++frame) {
      graph.motions[0].translation.y() = frame;
      history.Append({frame, true, graph.motions, {1}});
    }
    history.Finish();
    models.Add(PlateMesh(0.1 * number, 0.1, 0.05, 1), graph,
               std::move(history));
  }
  return models;
}

void ExpectOneAndTwo(const RetiredModels& models) {
  ASSERT_EQ(models.size(), 2);
  for (const int i : {1, 0}) {
    const TrackedModel model = models.At(i);
    EXPECT_EQ(model.mesh.vertices,
              PlateMesh(0.1 * (i + 1), 0.1, 0.05, 1).vertices);
    EXPECT_EQ(model.graph.motions[0].translation.x(), i + 1);
    ASSERT_EQ(model.history.size(), 3 * (i + 1));
    EXPECT_EQ(model.history.At(2).motions[0].translation.y(), 2);
    EXPECT_TRUE(model.history.At(2).Saw(0));
  }
}

TEST(RetiredModels, ComeBackAsTheyWere) { ExpectOneAndTwo(OneAndTwo()); }

TEST(RetiredModels, GoOnAfterACheckpoint) {
  RetiredModels models = OneAndTwo();
  std::stringstream stream;
  ArchiveWriter writer(&stream);
  writer(models);
  writer.Flush();
  RetiredModels other(std::make_shared<SpoolFile>());
  ArchiveReader reader(&stream, stream.str().size(), "checkpoint");
  reader(other);
  ExpectOneAndTwo(other);
}

}  // namespace
}  // namespace splitfusion
