#include "splitfusion/pipelines/tracker_options.h"

#include <cmath>

#include "splitfusion/lib/base/pi.h"

namespace splitfusion {
namespace {

double Radians(double degrees) { return degrees * kPi<double> / 180; }

}  // namespace

std::vector<TrackingStage> TrackerOptions::RigidStages() const {
  // Gates shrink by the same factor from stage to stage.
  const auto gates = [&](double distance, double angle, bool coarse) {
    return AssociationGates{distance * rigid_distance,
                            Radians(angle * rigid_angle),
                            Radians(grazing_angle), coarse};
  };
  return {{8, 5, gates(1, 1, true)},
          {4, 4, gates(std::sqrt(1.0 / 2), std::sqrt(2.0 / 3), false)},
          {2, 4, gates(1.0 / 2, 2.0 / 3, false)}};
}

std::vector<TrackingStage> TrackerOptions::NonRigidStages() const {
  const auto gates = [&](double distance, bool coarse) {
    return AssociationGates{distance * non_rigid_distance,
                            Radians(non_rigid_angle), Radians(grazing_angle),
                            coarse, coarse ? lost_distance : 0};
  };
  return {{4, 3, gates(1, true)}, {4, 5, gates(0.5, false)}};
}

void TrackerOptions::List(OptionList* list) {
  list->Text("association", &association,
             "How pairs of model and live points are found: projective, in the "
             "pixel that the model point projects to, or closest_point in "
             "space.")
      .common = true;
  list->Number("rigid_distance", &rigid_distance, Range::Above(0), "metres",
               "Largest distance of pairs in the first rigid stage, but at "
               "least three times the depth noise; the last has half of it.")
      .common = true;
  list->Number(
          "rigid_angle", &rigid_angle, {0, 180, true}, "degrees",
          "Largest angle of normals in the first rigid stage; the last has "
          "two thirds of it.")
      .common = true;
  list->Number("non_rigid_distance", &non_rigid_distance, Range::Above(0),
               "metres",
               "Largest distance of pairs in the first non-rigid stage; the "
               "last has half of it.")
      .common = true;
  list->Number("non_rigid_angle", &non_rigid_angle, {0, 180, true}, "degrees",
               "Largest angle of normals in the non-rigid stages.")
      .common = true;
  list->Number(
      "lost_distance", &lost_distance, Range::AtLeast(0), "metres",
      "In the first non-rigid stage live points without model are paired, "
      "for live_to_model, with model points astray up to this far "
      "(projective association only).");
  list->Number("grazing_angle", &grazing_angle, {0, 90, true}, "degrees",
               "Between live normal and view ray; beyond, depth is not used.");
  list->Number(
      "prior_anneal", &prior_anneal, Range::AtLeast(1), "",
      "Over the non-rigid rounds of a frame, anneal falls from this to "
      "1; temporal_arap has (anneal - 1) times its weight.");
  list->Number(
      "settled", &settled, Range::AtLeast(0), "",
      "A rigid stage ends when the relative change of the cost is smaller.");
  ListBounds(list);
  list->Part("", &part_start);
  list->Number("velocity_gain", &velocity_gain, Range::Above(0), "",
               "Tracking starts from constant velocity if its misfit is below "
               "this fraction of that of standing still.");
  list->Switch("keep_radius", &keep_radius,
               "The trust region of a round starts from that of the round "
               "before.");
  list->Number(
      "min_samples", &min_samples, Range::AtLeast(0), "",
      "A surface with fewer samples is tracked at half the stride, or a "
      "quarter and so on, until it has as many.");
}

void TrackerOptions::ListBounds(OptionList* list) {
  list->Number("min_correspondences", &min_correspondences, Range::AtLeast(6),
               "pairs", "With fewer in the last round a surface is lost.");
  list->Number("min_accepted", &min_accepted, Range::Share(), "",
               "With a smaller share of its samples on live depth paired, a "
               "surface is lost.");
  list->Number("min_fit", &min_fit, Range::Share(), "",
               "With a smaller share of its points in view on live depth, a "
               "deforming surface is lost.");
  list->Number("max_translation", &max_translation, Range::Above(0), "metres",
               "Moved farther by the rigid stages, a surface is lost.");
  list->Number("max_rotation", &max_rotation, {0, 180, true}, "degrees",
               "Rotated farther by the rigid stages, a surface is lost.");
}

void TrackerOptions::Check() const { CheckOptions(*this); }

}  // namespace splitfusion
