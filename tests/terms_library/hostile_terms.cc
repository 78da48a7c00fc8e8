// A shared library of terms that does what environment variables say, for
// tests/tools/hostile_libraries_test.cc and hostile_runs_test.cc.

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/terms_library.h"

namespace {

using splitfusion::EnergyInput;
using splitfusion::EnergyTerm;
using splitfusion::InputError;
using splitfusion::ResidualSink;
using splitfusion::TermRegistry;
using splitfusion::TermState;

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

void Throw() { throw std::runtime_error("gone"); }

/// Ends in std::terminate().
void ThrowWhereNoneMay() noexcept { Throw(); }

/// How the library ends what it is asked for: HOSTILE_WAY.
void EndIt() {
  const std::string way = Variable("HOSTILE_WAY");
  if (way == "throw") Throw();
  if (way == "throw_input_error") throw InputError("a.csv: gone");
  if (way == "throw_number") throw 42;
  if (way == "throw_where_none_may") ThrowWhereNoneMay();
  if (way == "exit") std::exit(0);
  if (way == "abort") std::abort();
  if (way == "segv") std::raise(SIGSEGV);
  if (way == "fpe") std::raise(SIGFPE);
  if (way == "ill") std::raise(SIGILL);
  if (way == "bus") std::raise(SIGBUS);
}

/// The same if it is asked for here: HOSTILE_AT, from frame HOSTILE_FRAME on.
void EndAt(const std::string& at, const EnergyInput* input = nullptr) {
  if (Variable("HOSTILE_AT") != at) return;
  if (input != nullptr && (input->context.frame == nullptr ||
                           input->context.frame->index <
                               std::atoi(Variable("HOSTILE_FRAME").c_str()))) {
    return;
  }
  EndIt();
}

/// Pulls a node back a little, if it does not end it all.
struct Pull {
  static constexpr int kResiduals = 1;
  bool ends;
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    if (ends) EndIt();
    residual[0] = twists[0][5];
    if (ends && Variable("HOSTILE_WAY") == "nan") residual[0] *= std::nan("");
    return true;
  }
};

struct Nothing : TermState {
  std::string Save() const override {
    EndAt("Save");
    return "";
  }
  void Load(const std::string& /*bytes*/) override { EndAt("Load"); }
};

class HostileTerm : public EnergyTerm {
 public:
  std::unique_ptr<TermState> NewState() const override {
    EndAt("NewState");
    return std::make_unique<Nothing>();
  }
  void Prepare(const EnergyInput& input, TermState* /*state*/) const override {
    EndAt("Prepare", &input);
  }
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    EndAt("AddResiduals", &input);
    const bool ends = Variable("HOSTILE_AT") == "evaluating" &&
                      input.context.frame->index >=
                          std::atoi(Variable("HOSTILE_FRAME").c_str());
    sink->AddNodes({{0}}, std::vector<Pull>{{ends}});
  }
};

class OutOfRange : public HostileTerm {
  void List(splitfusion::OptionList* list) override {
    list->Number("reach", &reach_, splitfusion::Range::Above(0), "metres", "");
  }
  double reach_ = -1;
};

class TwoWeights : public HostileTerm {
  void List(splitfusion::OptionList* list) override {
    list->Number("weight", &weight_, splitfusion::Range::Above(0), "", "");
  }
  double weight_ = 1;
};

class ThrowsInList : public HostileTerm {
  void List(splitfusion::OptionList* /*list*/) override { throw 42; }
};

class NamelessUnknown : public HostileTerm {
  std::vector<splitfusion::Unknown> Unknowns() const override {
    return {{"", "", 0}};
  }
};

template <typename Term>
std::unique_ptr<EnergyTerm> Make() {
  return std::make_unique<Term>();
}

/// What is registered under HOSTILE_ADDS.
void AddTerms(TermRegistry* terms) {
  EndAt("AddTerms");
  const std::string adds = Variable("HOSTILE_ADDS");
  const std::map<std::string, TermRegistry::Factory> factories = {
      {"null", [] { return std::unique_ptr<EnergyTerm>(); }},
      {"no_factory", nullptr},
      {"out_of_range", Make<OutOfRange>},
      {"two_weights", Make<TwoWeights>},
      {"throws_in_list", Make<ThrowsInList>},
      {"nameless_unknown", Make<NamelessUnknown>},
      {"throwing_factory",
       []() -> std::unique_ptr<EnergyTerm> { throw std::runtime_error("no"); }},
  };
  const auto found = factories.find(adds);
  if (found != factories.end())
    return terms->Register("hostile", found->second);
  if (adds == "nothing") return;
  if (adds == "all_anew") *terms = TermRegistry("term");
  if (adds.rfind("name ", 0) == 0) {
    return terms->Register(adds.substr(5), Make<HostileTerm>);
  }
  if (adds == "twice") terms->Register("hostile", Make<HostileTerm>);
  terms->Register("hostile", Make<HostileTerm>);
}

/// Runs when the library is loaded.
struct Loading {
  Loading() { EndAt("loading"); }
} const loading;

}  // namespace

SPLITFUSION_TERMS_LIBRARY(AddTerms)
