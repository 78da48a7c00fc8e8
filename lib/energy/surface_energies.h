#ifndef SPLITFUSION_LIB_ENERGY_SURFACE_ENERGIES_H_
#define SPLITFUSION_LIB_ENERGY_SURFACE_ENERGIES_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/term_registry.h"

namespace splitfusion {

/// A class name as keys have it: whatever is no letter or digit is a _, as in
/// teddy_bear.
std::string ClassKey(const std::string& class_name);

/// Whether a key of --set is one of the energy: terms.NAME.KEY, or
/// CLASS.terms.NAME.KEY.
bool IsTermKey(const std::string& key);

/// The energy (Eq. 4) of every surface: one for all, some options of which are
/// others for the surfaces of a class.
class SurfaceEnergies {
 public:
  /// The same one for every surface.
  SurfaceEnergies(Energy all)  // NOLINT(runtime/explicit): it is one.
      : all_(std::move(all)) {}

  /// Parses text as ParseEnergy() does, in which a term after the key of a
  /// class and a dot changes what it spells out for that class alone:
  /// `point_to_plane arap(weight=8) person.arap(weight=4)`. A term that stands
  /// after a class only is one of that class's energy only.
  ///
  /// @throw InputError as ParseEnergy(), and if a term of a class spells out
  ///     nothing.
  static SurfaceEnergies Parse(const std::string& text,
                               const TermRegistry& registry);

  /// The energy of all surfaces that have no other.
  const Energy& all() const { return all_; }
  /// The energy of a surface of this class name.
  const Energy& Of(const std::string& class_name) const;
  /// Keys of the classes that have options of their own.
  std::vector<std::string> classes() const;

  /// Sets one option: `key` is terms.NAME.KEY, or CLASS.terms.NAME.KEY.
  ///
  /// @throw InputError as SetTermOption().
  void Set(const std::string& key, const std::string& value,
           const TermRegistry& registry);

  /// @throw InputError as CheckEnergy() of any of them.
  void Check() const;

  /// Text that Parse() reads back.
  std::string Text() const;

  /// Every option by the key that sets it; of classes only those of their own.
  std::map<std::string, std::string> OptionValues() const;

 private:
  /// NAME.KEY -> value.
  using Changes = std::map<std::string, std::string>;

  /// The energies of classes, from that of all and what differs.
  void MakeClasses(const TermRegistry& registry);

  Energy all_;
  std::map<std::string, Changes> changes_;  // By key of the class.
  std::map<std::string, Energy> of_class_;  // Likewise.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SURFACE_ENERGIES_H_
