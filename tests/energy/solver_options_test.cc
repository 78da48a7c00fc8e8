#include <gtest/gtest.h>

#include <functional>

#include "splitfusion/lib/energy/solver.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

void ExpectRefused(const std::function<void(SolverOptions*)>& set,
                   const std::string& message) {
  SolverOptions options;
  set(&options);
  const auto make = [&] {
    options.Check();
    BuiltinSolvers().Make(options.solver, options);
  };
  ExpectInputError(make, message);
}

TEST(SolverOptions, DefaultsAndKnownNamesPass) {
  SolverOptions options;
  options.solver = "ceres";
  for (const char* solver : {"auto", "dense_qr", "dense_normal_cholesky",
                             "sparse_normal_cholesky", "cgnr"}) {
    options.linear_solver = solver;
    EXPECT_NO_THROW(options.Check()) << solver;
  }
}

TEST(SolverOptions, UnknownNamesListTheKnownOnes) {
  const std::string solvers =
      "expected auto, dense_qr, dense_normal_cholesky, "
      "sparse_normal_cholesky or cgnr";
  for (const char* name : {"cholesky", "", "dense_schur", "iterative_schur"}) {
    ExpectRefused([&](SolverOptions* o) { o->linear_solver = name; },
                  std::string("linear_solver = ") + name + ": " + solvers);
  }
  ExpectRefused([](SolverOptions* o) { o->preconditioner = "schur_jacobi"; },
                "preconditioner = schur_jacobi: expected auto, jacobi or "
                "identity");
  ExpectRefused(
      [](SolverOptions* o) { o->trust_region = "newton"; },
      "trust_region = newton: expected levenberg_marquardt, dogleg or "
      "subspace_dogleg");
}

TEST(SolverOptions, DoglegNeedsAFactorisation) {
  ExpectRefused(
      [](SolverOptions* o) {
        o->solver = "ceres";
        o->trust_region = "dogleg";
        o->linear_solver = "cgnr";
      },
      "trust_region = dogleg: expected levenberg_marquardt with "
      "linear_solver cgnr");
}

TEST(SolverOptions, WhatHasNoEffectIsRefused) {
  const std::string ceres = "as it has no effect but with solver ceres";
  ExpectRefused([](SolverOptions* o) { o->linear_solver = "dense_qr"; },
                "linear_solver = dense_qr: expected auto, " + ceres);
  ExpectRefused(
      [](SolverOptions* o) { o->trust_region = "dogleg"; },
      "trust_region = dogleg: expected levenberg_marquardt, " + ceres);
  ExpectRefused([](SolverOptions* o) { o->minimizer = "lbfgs"; },
                "minimizer = lbfgs: expected trust_region, " + ceres);
  ExpectRefused([](SolverOptions* o) { o->threads = 2; },
                "solver_threads = 2: expected 1, " + ceres);
  ExpectRefused(
      [](SolverOptions* o) {
        o->solver = "gn_cholesky";
        o->preconditioner = "identity";
      },
      "preconditioner = identity: expected auto, as it has no effect but with "
      "solver gn_pcg or linear_solver cgnr");
  ExpectRefused(
      [](SolverOptions* o) {
        o->solver = "gn_cholesky";
        o->eta = 0.5;
      },
      "eta = 0.5: expected 0.01, as it has no effect but with solver gn_pcg or "
      "linear_solver cgnr");
  ExpectRefused([](SolverOptions* o) { o->sparse_library = "eigen_sparse"; },
                "sparse_library = eigen_sparse: expected suite_sparse");
  ExpectRefused([](SolverOptions* o) { o->ordering = "nesdis"; },
                "ordering = nesdis: expected amd, as it has no effect but with "
                "solver gn_cholesky");
  ExpectRefused(
      [](SolverOptions* o) {
        o->solver = "ceres";
        o->sparse_library = "eigen_sparse";
        o->ordering = "natural";
      },
      "ordering = natural: expected amd");
  ExpectRefused(
      [](SolverOptions* o) {
        o->solver = "ceres";
        o->minimizer = "lbfgs";
        o->linear_solver = "dense_qr";
      },
      "minimizer = lbfgs: expected trust_region");
}

TEST(SolverOptions, RefuseValuesOutOfRange) {
  ExpectRefused([](SolverOptions* o) { o->threads = 0; },
                "solver_threads = 0: expected 1..1024");
  ExpectRefused([](SolverOptions* o) { o->max_iterations = 0; },
                "solver_iterations = 0: expected >= 1");
  ExpectRefused([](SolverOptions* o) { o->max_linear_solver_iterations = -3; },
                "linear_iterations = -3: expected >= 1");
  ExpectRefused([](SolverOptions* o) { o->eta = 1; },
                "eta = 1: expected 0..1, not 0, not 1");
  ExpectRefused([](SolverOptions* o) { o->function_tolerance = -1; },
                "function_tolerance = -1: expected >= 0");
  ExpectRefused([](SolverOptions* o) { o->gradient_tolerance = -1; },
                "gradient_tolerance = -1: expected >= 0");
  ExpectRefused([](SolverOptions* o) { o->parameter_tolerance = -1; },
                "parameter_tolerance = -1: expected >= 0");
  ExpectRefused([](SolverOptions* o) { o->initial_radius = 0; },
                "initial_radius = 0: expected > 0");
  for (const double radius : {1e30, 1e-40}) {
    ExpectRefused(
        [&](SolverOptions* o) {
          o->solver = "ceres";
          o->initial_radius = radius;
        },
        "expected 1e-32..1e16 with solver ceres");
    SolverOptions options;
    options.initial_radius = radius;
    EXPECT_NO_THROW(options.Check());
  }
}

}  // namespace
}  // namespace splitfusion
