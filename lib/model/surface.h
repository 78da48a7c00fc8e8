#ifndef SPLITFUSION_LIB_MODEL_SURFACE_H_
#define SPLITFUSION_LIB_MODEL_SURFACE_H_

#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/deformation/graph_growth.h"
#include "splitfusion/lib/deformation/mesh_skinning.h"
#include "splitfusion/lib/deformation/motion_log.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/model/refuted_parts.h"
#include "splitfusion/lib/model/retired_models.h"
#include "splitfusion/lib/model/surface_model.h"
#include "splitfusion/lib/model/unconfirmed_nodes.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/tsdf/mesh_extractor.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"
#include "splitfusion/lib/tsdf/warped_integration.h"

namespace splitfusion {

/// How one surface is modelled.
struct SurfaceOptions {
  /// Voxels and truncation.
  TsdfOptions tsdf;
  /// Observations a voxel needs before it is meshed (weights, about frames at
  /// close range); at most MeshExtractor::kMaxMinWeight.
  double min_mesh_weight = 0.05;
  /// Pieces of the final mesh smaller than this are left out, square metres:
  /// noise, and remains of what moved on.
  double min_piece_area = 0.01;
  /// A non-rigid surface grows over live points that are no farther than this
  /// from a node, metres: as far as a newly seen limb reaches in one frame.
  double growth_reach = 0.35;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;
};

/// One surface of the scene: its volume, its warp field and its history. A
/// rigid surface has a one-node graph (SplitFusion IV-B) and the same code
/// path; only the room-sized background is rendered by ray casting instead of
/// from its mesh.
class Surface {
 public:
  /// `id` 0 is the background. The canonical frame is the camera frame of the
  /// first fused frame.
  Surface(int id, std::string label, SurfaceKind kind, int first_frame,
          const SurfaceOptions& options,
          const GraphOptions& graph_options = {});

  /// First observation: fills the volume in the camera frame and places the
  /// graph. Returns whether there is a surface to speak of.
  bool Initialize(const LiveView& live);

  /// Begins the model anew from the live pixels of this surface, in the camera
  /// frame; the one so far is kept for the frames so far. For a surface that is
  /// in view and that its model cannot be found in any more. Returns whether
  /// there is anything to begin with; otherwise nothing changes.
  bool Reanchor(const LiveView& live);

  /// Fuses the live pixels of this surface under the current motions, which
  /// were just tracked. Parts of a deforming one that live depth refutes now
  /// are left alone, and forgotten after GraphOptions::refuted_frames frames on
  /// end; the model for the frames so far keeps them. Returns the number of
  /// nodes whose parts were forgotten.
  int Fuse(const LiveView& live);

  /// Forgets what was fused within the truncation from these places of the
  /// canonical frame (metres), of a rigid surface: it is not of this one.
  void Forget(const std::vector<Eigen::Vector3f>& places);

  /// Forgets, of a rigid surface, what was fused within the truncation from the
  /// points that live pixels of the surface `other` show for sure
  /// (IsCertain()), under the current motion.
  void ForgetOther(const LiveView& live, int other);

  /// Extracts the canonical mesh; its graph follows it.
  void UpdateMesh();

  /// Tears a deforming surface where it is stretched more than a surface
  /// stretches and nothing is seen before it: what touched when it was first
  /// seen, an arm and the chest, hangs together no more. Its mesh has a gap
  /// there, and the graph is tied along what is left. `live`: of the frame to
  /// which the motions belong. Returns the number of triangles. Not in the
  /// paper.
  int Tear(const LiveView& live);

  /// Extracts the final canonical mesh, without small pieces.
  void FinishMesh();

  /// Of every node whether it is in view where the current motions, which were
  /// just tracked, have it: a live pixel of the surface lies within the
  /// truncation, beside the noise. All of a rigid surface are.
  std::vector<char> SeenNodes(const LiveView& live) const;

  /// Appends the current motions to the history, and which nodes were seen
  /// (FrameMotions::seen). New nodes count in DeformationGraph::first_seen from
  /// this frame on.
  ///
  /// @throw InputError as MotionLog::Append().
  void RecordMotions(int frame, bool tracked, std::vector<char> seen = {});

  /// Sets the motion of frame `i` of a rigid surface's history, camera from
  /// canonical, metres.
  ///
  /// @throw InputError as MotionLog::Replace().
  void PlaceIn(int i, const Rigid3d& motion);

  /// Mesh vertices under the current motions, camera frame.
  std::vector<Eigen::Vector3f> WarpedVertices() const;

  /// Surface id; 0 is the background.
  int id() const { return id_; }
  /// Class name.
  const std::string& label() const { return label_; }
  /// Changes the class name.
  void set_label(const std::string& label) { label_ = label; }
  /// Whether one motion or many carry it.
  SurfaceKind kind() const { return kind_; }
  /// Frame of its first observation.
  int first_frame() const { return first_frame_; }
  /// Out of view or missed too long: kept, but neither tracked nor drawn.
  bool inactive() const { return inactive_; }
  /// Sets inactive().
  void set_inactive(bool inactive) { inactive_ = inactive; }
  /// Whether it is what nothing else is.
  bool is_background() const { return id_ == 0; }
  /// Drawn by ray casting, not from the mesh.
  bool is_ray_cast() const {
    return is_background() && kind_ == SurfaceKind::kRigid;
  }

  /// Options in use.
  const SurfaceOptions& options() const { return options_; }
  /// As given.
  const GraphOptions& graph_options() const { return graph_options_; }
  /// Deformation graph at the current motions.
  const DeformationGraph& graph() const { return graph_; }
  /// Node spacing that the options ask for, metres; 0 for a rigid surface. The
  /// graph's own is wider where GraphOptions::max_nodes would be exceeded.
  double planned_node_spacing() const { return graph_record_.planned_spacing; }
  /// The graph, for prediction and tracking.
  DeformationGraph* mutable_graph() { return &graph_; }
  /// Skinning by the current graph.
  const SkinningIndex& skinning_index() const { return *index_; }
  /// Its volume, canonical frame.
  const TsdfVolume& volume() const { return volume_; }
  /// Its mesh, canonical frame; see UpdateMesh() and FinishMesh().
  const TriangleMesh& mesh() const { return mesh_; }
  /// Skinning of the mesh's vertices.
  const std::vector<Skinning>& mesh_skinning() const {
    return mesh_skinning_.skinning();
  }
  /// Motions of all frames since its model began.
  const MotionLog& history() const { return history_; }
  /// Mesh, graph and motions of all its models and refuted parts.
  ///
  /// @throw InputError as MotionLog::All().
  SurfaceModel Model() const;

  /// Saves or restores all that later frames depend on, see
  /// lib/base/archive.h; of a surface made with the same arguments but for the
  /// label. What can be made from the rest bit for bit is left out: skinning,
  /// and the meshes of the volume's blocks.
  template <typename Archive>
  void Serialize(Archive* archive);

 private:
  void PlaceGraph(const LiveView& live);
  int FuseWarped(const LiveView& live, DepthObservation* observation);
  void ReleaseBlocks();
  std::vector<char> ConfirmedVertices() const;
  std::vector<char> NodesOf(const std::vector<int>& vertices) const;
  std::vector<char> NodesToForget() const;
  void Retire(const std::vector<char>& nodes);
  int ForgetRefuted();
  void UpdateMeshAndGraph(bool retie);
  void UpdateGraphOverMesh(bool retie);
  /// Makes what Serialize() leaves out.
  void RestoreCaches();

  int id_;
  std::string label_;
  SurfaceKind kind_;
  int first_frame_;
  bool inactive_ = false;
  SurfaceOptions options_;
  GraphOptions graph_options_;
  TsdfVolume volume_;
  WarpedIntegrator integrator_;
  DeformationGraph graph_;
  GraphRecord graph_record_;
  std::unique_ptr<SkinningIndex> index_;
  MeshExtractor mesh_extractor_;
  TriangleMesh mesh_;
  MeshSkinning mesh_skinning_;
  // What is not needed before the end lies there.
  std::shared_ptr<SpoolFile> spool_ = std::make_shared<SpoolFile>();
  MotionLog history_{spool_};
  RefutedParts refuted_;
  UnconfirmedNodes unconfirmed_;
  std::size_t kept_blocks_ = 0;  // When free ones were released last.
  // What it was before Reanchor(), and parts that were refuted.
  RetiredModels retired_{spool_};
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_SURFACE_H_
