#include "splitfusion/lib/experiment/solver_setting.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// The choice that a word is of.
Option* FindChoice(const std::string& word, std::vector<Option>* options) {
  for (Option& option : *options) {
    const auto& choices = option.choices;
    if (std::find(choices.begin(), choices.end(), word) != choices.end()) {
      return &option;
    }
  }
  return nullptr;
}

bool TakesPreconditioner(const SolverOptions& options) {
  return options.solver == "gn_pcg" || options.linear_solver == "cgnr";
}

}  // namespace

SolverSetting ParseSolverSetting(const std::string& text,
                                 const SolverOptions& base,
                                 const SolverRegistry& solvers) {
  SolverSetting setting;
  setting.name = text;
  setting.options = base;
  OptionList list;
  setting.options.List(&list);
  std::vector<Option> options = list.options();
  std::istringstream words(text);
  std::getline(words, setting.options.solver, ':');
  solvers.Check(setting.options.solver);
  setting.solver = setting.options.solver;
  std::set<std::string> chosen;
  for (std::string word; std::getline(words, word, ':');) {
    Option* choice = FindChoice(word, &options);
    CheckOption(
        choice != nullptr, "solvers", text,
        "SOLVER:CHOICE:..., but '" + word + "' is no choice of a solver");
    CheckOption(chosen.insert(choice->name).second, "solvers", text,
                "one " + choice->name + " for each solver");
    choice->Set(word);
    if (choice->name != "preconditioner") setting.solver += ":" + word;
  }
  setting.options.Check();
  solvers.Make(setting.options.solver, setting.options);
  const std::string& used = setting.options.preconditioner;
  setting.preconditioner = !TakesPreconditioner(setting.options) ? "none"
                           : used == "auto"                      ? "jacobi"
                                                                 : used;
  return setting;
}

std::vector<std::string> BuiltinSolverSettings() {
  return {"gn_pcg",
          "gn_pcg:identity",
          "gn_cholesky",
          "gn_cholesky:nesdis",
          "ceres:sparse_normal_cholesky",
          "ceres:sparse_normal_cholesky:dogleg",
          "ceres:sparse_normal_cholesky:subspace_dogleg",
          "ceres:sparse_normal_cholesky:eigen_sparse",
          "ceres:sparse_normal_cholesky:nesdis",
          "ceres:cgnr",
          "ceres:cgnr:identity",
          "ceres:dense_normal_cholesky",
          "ceres:dense_qr",
          "ceres:lbfgs",
          "ceres:nonlinear_cg"};
}

}  // namespace splitfusion
