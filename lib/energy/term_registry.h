#ifndef SPLITFUSION_LIB_ENERGY_TERM_REGISTRY_H_
#define SPLITFUSION_LIB_ENERGY_TERM_REGISTRY_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/base/registry.h"
#include "splitfusion/lib/energy/term_options.h"
#include "splitfusion/lib/energy/term_text.h"

namespace splitfusion {

class EnergyTerm;

/// Terms by name.
using TermRegistry = Registry<EnergyTerm>;

/// A term with its options.
struct WeightedTerm {
  /// Name, weight and loss.
  TermOptions options;
  /// The term itself, with its own parameters.
  std::shared_ptr<EnergyTerm> term;
};

/// The energy of Eq. 4: a sum of weighted terms. Copies share their terms.
using Energy = std::vector<WeightedTerm>;

/// Parses the energy from text like
/// `point_to_plane(weight=1,loss=tukey,scale=0.01) arap(weight=5)`. Keys of a
/// term are weight, loss, scale and those that it lists itself.
///
/// @throw InputError on an unknown term or key, a value that is not what is
///     expected, or a syntax error; says what is known.
Energy ParseEnergy(const std::string& text, const TermRegistry& registry);

/// The energy of these entries, as ParseEnergy().
///
/// @throw InputError as ParseEnergy(), and if one is of a class only.
Energy MakeEnergy(const std::vector<TermText>& terms,
                  const TermRegistry& registry);

/// A term with its defaults.
///
/// @throw InputError if none of that name is registered, or it is not what a
///     term must be: its name, its keys, or their defaults.
WeightedTerm MakeTerm(const std::string& name, const TermRegistry& registry);

/// Checks what any code may have set, and no parser has read.
///
/// @throw InputError if there is no term, or weight, loss or scale are out of
///     their ranges.
void CheckTerm(const WeightedTerm& term);

/// @throw InputError if no term has a weight: nothing would be minimised; or
///     on unknowns of a term without a name, of one name, or with values that
///     are none.
void CheckEnergy(const Energy& energy);

/// Text that ParseEnergy() reads back, every option spelled out.
std::string EnergyText(const Energy& energy);

/// Sets one option of a term: `key` is NAME.KEY, as in arap.weight. A term that
/// the energy lacks is appended.
///
/// @throw InputError as ParseEnergy().
void SetTermOption(const std::string& key, const std::string& value,
                   const TermRegistry& registry, Energy* energy);

/// Every option of every term: NAME.KEY -> value.
std::map<std::string, std::string> TermOptionValues(const Energy& energy);

/// What every registered term takes, for the command line: its name alone in a
/// line, below it every key with default, range and meaning, indented.
std::string TermsHelp(const TermRegistry& registry);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_REGISTRY_H_
