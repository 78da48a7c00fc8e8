// The paper's claim: a room and two people as one deformation graph over
// everything, and as split surfaces, for the same pairs of points.

#include <limits>

#include "growth_curves.h"
#include "split_models.h"
#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/pipelines/pipeline_options.h"
#include "volumes.h"

namespace splitfusion {
namespace {

double GraphBytes(const DeformationGraph& graph) {
  double bytes = graph.size() * (sizeof(Eigen::Vector3d) + sizeof(NodeMotion));
  for (const auto& neighbors : graph.neighbors) {
    bytes += sizeof(neighbors) + neighbors.size() * sizeof(int);
  }
  return bytes;
}

/// Of the assembled J^T J and J^T r.
double SystemBytes(const SymmetricBlockMatrix& matrix) {
  return static_cast<double>(matrix.block_count() *
                                 (sizeof(Block6) + sizeof(int)) +
                             matrix.size() * (sizeof(Vector6) + sizeof(int)));
}

/// The energy of one surface at its association.
SurfaceProblem ProblemOf(const PairedSurface& part, const Energy& energy,
                         const LiveView& live) {
  const auto& motions = part.surface->graph().motions;
  return {energy, part.pairs, live.camera, &live, &motions};
}

/// Measures one model; all surfaces one after the other.
class ModelMeasurement {
 public:
  ModelMeasurement(const std::string& name, SceneModel model, int repetitions)
      : name_(name), model_(std::move(model)), repetitions_(repetitions) {}

  std::vector<GrowthRow> Rows() {
    return {Solve("gn_pcg"), Solve("gn_cholesky"), Fuse()};
  }

 private:
  GrowthRow Row(const std::string& series, double seconds, double bytes) {
    double nodes = 0;
    for (const PairedSurface& part : model_.surfaces) {
      nodes += part.surface->graph().size();
    }
    return {name_, series, {seconds, bytes, nodes}};
  }

  /// One call of the minimiser a surface, with default options; memory of
  /// graphs and normal equations.
  GrowthRow Solve(const std::string& solver) {
    const Energy energy = ParseEnergy(PipelineOptions().terms, BuiltinTerms());
    SolverOptions options;
    options.solver = solver;
    double bytes = 0;
    for (const PairedSurface& part : model_.surfaces) {
      const SurfaceProblem problem = ProblemOf(part, energy, model_.after);
      const DeformationGraph& graph = part.surface->graph();
      bytes += GraphBytes(graph) +
               SystemBytes(BlockProblem(problem, graph).MakeMatrix());
    }
    const double seconds = FastestRun(repetitions_, [&] {
      for (const PairedSurface& part : model_.surfaces) {
        DeformationGraph graph = part.surface->graph();
        Minimize(ProblemOf(part, energy, model_.after), options, &graph);
      }
    });
    return Row("solve " + solver, seconds, bytes);
  }

  /// A frame into every volume, and their memory; the first time fills the
  /// caches.
  GrowthRow Fuse() {
    const auto fuse = [this] {
      for (PairedSurface& part : model_.surfaces) {
        part.surface->Fuse(model_.after);
      }
    };
    fuse();
    const double seconds = FastestRun(repetitions_, fuse);
    double bytes = 0;
    for (const PairedSurface& part : model_.surfaces) {
      bytes += VolumeBytes(part.surface->volume());
    }
    return Row("fuse", seconds, bytes);
  }

  std::string name_;
  SceneModel model_;
  int repetitions_;
};

SurfaceOptions OptionsFor(const GrowthSizes& sizes,
                          const SurfaceOptions& options) {
  return WithVoxels(options, options.tsdf.voxel_size * sizes.voxel_factor);
}

}  // namespace

GrowthTable OneGraphTable(const GrowthSizes& sizes) {
  GrowthTable table;
  table.columns = {"model", "series", "seconds", "bytes", "nodes"};
  const auto measure = [&](const std::string& name, SceneModel model) {
    ModelMeasurement measurement(name, std::move(model), sizes.repetitions);
    for (GrowthRow& row : measurement.Rows()) {
      table.rows.push_back(std::move(row));
    }
  };
  const FramePair frames(sizes.height);
  const PipelineOptions defaults;
  const SurfaceOptions room = OptionsFor(sizes, defaults.background);
  const SurfaceOptions person = OptionsFor(sizes, defaults.object);
  GraphOptions graph;
  graph.near_spacing = graph.far_spacing = sizes.spacing;
  GraphOptions unlimited = graph;
  unlimited.max_nodes = std::numeric_limits<int>::max();
  measure("split", MakeSplitModel(frames, room, person, graph));
  measure("one_graph_preset", MakeOneGraphModel(frames, room, graph));
  measure("one_graph_as_fine", MakeOneGraphModel(frames, person, unlimited));
  return table;
}

}  // namespace splitfusion
