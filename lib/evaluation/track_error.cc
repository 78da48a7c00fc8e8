#include "splitfusion/lib/evaluation/track_error.h"

#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr std::size_t kMinRigidPoints = 4;

/// Errors of one instance, metres.
struct Errors {
  std::vector<double> visible, occluded, still_world, rigid;

  void Append(const Errors& other) {
    const auto append = [](const std::vector<double>& from,
                           std::vector<double>* to) {
      to->insert(to->end(), from.begin(), from.end());
    };
    append(other.visible, &visible);
    append(other.occluded, &occluded);
    append(other.still_world, &still_world);
    append(other.rigid, &rigid);
  }

  TrackError Summarized() const {
    return {Summarize(visible), Summarize(occluded), Summarize(still_world),
            Summarize(rigid)};
  }
};

/// Points of one instance in one frame.
using Group = std::vector<TrackPoint>;
using GroupKey = std::pair<int, int>;  ///< Instance, frame.

std::map<GroupKey, Group> GroupPoints(const std::vector<TrackPoint>& followed,
                                      const TrueTracks& truth,
                                      int reference_frame) {
  std::map<GroupKey, Group> groups;
  for (const TrackPoint& point : followed) {
    CheckOption(point.id >= 0 && point.id < truth.points(), "track point id",
                point.id, "0.." + std::to_string(truth.points() - 1));
    CheckOption(point.frame >= 0 && point.frame < truth.frames(),
                "frame of a track point", point.frame,
                "0.." + std::to_string(truth.frames() - 1));
    if (point.frame == reference_frame) continue;
    groups[{truth.Instance(point.id), point.frame}].push_back(point);
  }
  return groups;
}

/// The rigid motion of the world that carries the true points of a group from
/// the reference frame best.
Rigid3d BestRigidMotion(const Group& group, const TrueTracks& truth,
                        int reference_frame) {
  const auto count = static_cast<Eigen::Index>(group.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = truth.Position(reference_frame, group[i].id);
    to.col(i) = truth.Position(group[i].frame, group[i].id);
  }
  Rigid3d motion;
  motion.matrix() = Eigen::umeyama(from, to, /*with_scaling=*/false);
  return motion;
}

void AddErrors(const Group& group, const TrueTracks& truth,
               const Rigid3d& world_from_camera, int reference_frame,
               Errors* errors) {
  const bool rigid_known = group.size() >= kMinRigidPoints;
  const Rigid3d motion = rigid_known
                             ? BestRigidMotion(group, truth, reference_frame)
                             : Rigid3d::Identity();
  for (const TrackPoint& point : group) {
    const Eigen::Vector3d position = truth.Position(point.frame, point.id);
    const double error = (world_from_camera * point.position - position).norm();
    if (!truth.Visible(point.frame, point.id)) {
      errors->occluded.push_back(error);
      continue;
    }
    const Eigen::Vector3d start = truth.Position(reference_frame, point.id);
    errors->visible.push_back(error);
    errors->still_world.push_back((start - position).norm());
    if (rigid_known)
      errors->rigid.push_back((motion * start - position).norm());
  }
}

}  // namespace

TrackErrors CompareTracks(const std::vector<TrackPoint>& followed,
                          const TrueTracks& truth,
                          const std::vector<Rigid3d>& world_from_camera,
                          int reference_frame) {
  CheckOption(
      world_from_camera.size() >= static_cast<std::size_t>(truth.frames()),
      "number of true poses", world_from_camera.size(),
      "one for each of the " + std::to_string(truth.frames()) +
          " frames of the tracks");
  std::map<int, Errors> instances;
  std::set<int> frames;
  std::set<int> ids;
  for (const auto& [key, group] :
       GroupPoints(followed, truth, reference_frame)) {
    const auto [instance, frame] = key;
    AddErrors(group, truth, world_from_camera[frame], reference_frame,
              &instances[instance]);
    frames.insert(frame);
    for (const TrackPoint& point : group) ids.insert(point.id);
  }
  TrackErrors result;
  result.reference_frame = reference_frame;
  result.frames = static_cast<int>(frames.size());
  result.points = static_cast<int>(ids.size());
  Errors all;
  for (const auto& [instance, errors] : instances) {
    result.instances[instance] = errors.Summarized();
    all.Append(errors);
  }
  result.all = all.Summarized();
  return result;
}

}  // namespace splitfusion
