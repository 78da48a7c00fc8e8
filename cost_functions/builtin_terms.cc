#include "splitfusion/cost_functions/builtin_terms.h"

#include "splitfusion/cost_functions/acceleration.h"
#include "splitfusion/cost_functions/arap.h"
#include "splitfusion/cost_functions/color_constancy.h"
#include "splitfusion/cost_functions/hidden_motion.h"
#include "splitfusion/cost_functions/live_to_model.h"
#include "splitfusion/cost_functions/normal.h"
#include "splitfusion/cost_functions/point_to_plane.h"
#include "splitfusion/cost_functions/point_to_point.h"
#include "splitfusion/cost_functions/point_to_tsdf.h"
#include "splitfusion/cost_functions/projective_depth.h"
#include "splitfusion/cost_functions/symmetric.h"
#include "splitfusion/cost_functions/temporal_arap.h"
#include "splitfusion/cost_functions/tracks.h"
#include "splitfusion/cost_functions/velocity.h"

namespace splitfusion {

TermRegistry BuiltinTerms() {
  TermRegistry registry("term");
  registry.Register("point_to_plane",
                    [] { return std::make_unique<PointToPlaneTerm>(); });
  registry.Register("color",
                    [] { return std::make_unique<ColorConstancyTerm>(); });
  registry.Register("arap", [] { return std::make_unique<ArapTerm>(); });
  registry.Register("live_to_model",
                    [] { return std::make_unique<LiveToModelTerm>(); });
  registry.Register("temporal_arap",
                    [] { return std::make_unique<TemporalArapTerm>(); });
  registry.Register("tracks", [] { return std::make_unique<TracksTerm>(); });
  registry.Register("point_to_point",
                    [] { return std::make_unique<PointToPointTerm>(); });
  registry.Register("symmetric",
                    [] { return std::make_unique<SymmetricTerm>(); });
  registry.Register("projective_depth",
                    [] { return std::make_unique<ProjectiveDepthTerm>(); });
  registry.Register("velocity",
                    [] { return std::make_unique<VelocityTerm>(); });
  registry.Register("acceleration",
                    [] { return std::make_unique<AccelerationTerm>(); });
  registry.Register("point_to_tsdf",
                    [] { return std::make_unique<PointToTsdfTerm>(); });
  registry.Register("normal", [] { return std::make_unique<NormalTerm>(); });
  registry.Register("hidden_arap",
                    [] { return std::make_unique<HiddenArapTerm>(); });
  registry.Register("hidden_smoothness",
                    [] { return std::make_unique<HiddenSmoothnessTerm>(); });
  return registry;
}

}  // namespace splitfusion
