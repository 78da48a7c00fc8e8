#include "splitfusion/lib/geometry/depth_noise.h"

#include "splitfusion/lib/base/option_list.h"

namespace splitfusion {

void DepthNoise::List(OptionList* list) {
  list->Number("least", &least, Range::Above(0), "metres",
               "Standard deviation of depth where it is least: sigma = least + "
               "growth (z - best)^2.");
  list->Number("growth", &growth, Range::AtLeast(0), "1/metres",
               "How it grows with the depth.");
  list->Number("best", &best, Range::AtLeast(0), "metres",
               "Depth at which it is least.");
  list->Number("reference", &reference, Range::Above(0), "metres",
               "Depth up to which a measurement has its full weight.");
  list->Demand(reference >= best, "reference", "metres >= noise_best");
}

}  // namespace splitfusion
