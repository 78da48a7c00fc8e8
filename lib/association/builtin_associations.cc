#include "splitfusion/lib/association/association.h"

namespace splitfusion {

AssociationRegistry BuiltinAssociations() {
  AssociationRegistry registry("association");
  registry.Register("projective", MakeProjectiveAssociator);
  registry.Register("closest_point", MakeClosestPointAssociator);
  return registry;
}

}  // namespace splitfusion
