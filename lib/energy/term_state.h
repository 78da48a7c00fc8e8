#ifndef SPLITFUSION_LIB_ENERGY_TERM_STATE_H_
#define SPLITFUSION_LIB_ENERGY_TERM_STATE_H_

#include <map>
#include <memory>
#include <string>
#include <typeindex>
#include <vector>

#include "splitfusion/lib/energy/term_registry.h"

namespace splitfusion {

class EnergyTerm;
struct EnergyInput;

/// What a term keeps of one surface, from frame to frame or for the rounds of
/// one frame; see EnergyTerm::NewState().
class TermState {
 public:
  virtual ~TermState() = default;

  /// What later frames depend on, as bytes for a checkpoint; empty if that is
  /// nothing, as where all is prepared anew in every frame.
  virtual std::string Save() const = 0;
  /// Makes a new state what Save() has kept.
  ///
  /// @throw InputError if the bytes are none of that.
  virtual void Load(const std::string& bytes) = 0;
};

/// What the terms of an energy keep of one surface.
class TermStates {
 public:
  /// Prepares the states of all terms that have one for the rounds of a frame,
  /// see EnergyTerm::Prepare(); new ones are made, also where a term of another
  /// class had the name before.
  ///
  /// @throw InputError or std::runtime_error if a term or a state throws; names
  ///     the term.
  void Prepare(const Energy& energy, const EnergyInput& input);

  /// That of the i-th term of an energy; null if it has none.
  const TermState* Find(const Energy& energy, std::size_t i) const;

  /// Takes the terms' own unknowns to where they begin a frame, see
  /// UnknownStart. `background`: what terms keep of the background, whose frame
  /// has ended; of itself these states.
  ///
  /// @throw InputError as DeclaredUnknowns().
  void BeginUnknowns(const Energy& energy, const TermStates& background);

  /// Where those of the i-th term of an energy began the frame, in the order of
  /// EnergyTerm::Unknowns(); null before BeginUnknowns().
  const std::vector<double>* Begun(const Energy& energy, std::size_t i) const;

  /// Keeps what the unknowns of all terms of an energy, in its order, have
  /// become; without values nothing.
  ///
  /// @throw InputError as DeclaredUnknowns(), and if these are others.
  void KeepUnknowns(const Energy& energy, const std::vector<double>& values);

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    std::map<std::string, std::string> saved = Save();
    (*archive)(saved, unknowns_);
    if constexpr (Archive::kReads) {
      states_.clear();
      saved_ = std::move(saved);
    }
  }

 private:
  /// The state of a term, made if it is none of its class; null if it has none.
  TermState* Keep(const std::string& name, const EnergyTerm& term);
  std::map<std::string, std::string> Save() const;

  /// Null, or made by a term of this class.
  struct Kept {
    std::type_index of;
    std::unique_ptr<TermState> state;
  };

  std::map<std::string, Kept> states_;  // By NameOf().
  /// Restored, of terms that have not been prepared since.
  std::map<std::string, std::string> saved_;
  std::map<std::string, std::vector<double>> unknowns_;  // Kept, by NameOf().
  std::map<std::string, std::vector<double>> begun_;     // Likewise.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_STATE_H_
