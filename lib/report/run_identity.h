#ifndef SPLITFUSION_LIB_REPORT_RUN_IDENTITY_H_
#define SPLITFUSION_LIB_REPORT_RUN_IDENTITY_H_

#include <map>
#include <string>

namespace splitfusion {

/// Named values: an option, or the hash of something that a run reads.
using NamedValues = std::map<std::string, std::string>;

/// What decides the result of a run, and what it writes besides.
struct RunIdentity {
  /// Options of the method, contents of what they name, the method itself. Runs
  /// that agree in all of them have the same result.
  NamedValues parts;
  /// Options of what is written about the result: pictures, meshes.
  NamedValues outputs;
  /// Of the options among `parts` that differ from their defaults, these; empty
  /// text where an option is there by another one alone. For people.
  NamedValues defaults = {};

  /// Of `parts`, 32 hexadecimal digits.
  std::string Hash() const;
};

/// What differs, for a line of text: "terms.arap.weight 8 -> 4, solver gn_pcg
/// -> ceres and 3 more"; hashes are not spelled out. Empty if nothing does.
std::string Differences(const NamedValues& before, const NamedValues& now);

/// The same over parts and outputs.
std::string Differences(const RunIdentity& before, const RunIdentity& now);

/// Hash of the sources of the method that this library was built from: all of
/// lib/, cost_functions/ and pipelines/ but for reports, evaluation and
/// synthetic scenes. 32 hexadecimal digits.
std::string MethodHash();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_RUN_IDENTITY_H_
