#ifndef SPLITFUSION_LIB_ENERGY_CERES_WATCH_H_
#define SPLITFUSION_LIB_ENERGY_CERES_WATCH_H_

#include <ceres/cost_function.h>

#include <exception>
#include <memory>
#include <mutex>
#include <string>

namespace splitfusion {

/// Keeps Ceres from what terms do wrong: its threads do not survive an
/// exception, and it says nothing of whose values are none.
class CeresWatch {
 public:
  CeresWatch() = default;
  CeresWatch(const CeresWatch&) = delete;             ///< Not copied.
  CeresWatch& operator=(const CeresWatch&) = delete;  ///< Not copied.

  /// The same cost of a term, but that an evaluation fails which throws or is
  /// not finite. This must outlive it.
  std::unique_ptr<ceres::CostFunction> Guard(
      const std::string& term, std::unique_ptr<ceres::CostFunction> cost);

  /// Throws the first exception of an evaluation, if there was one.
  void Rethrow() const;
  /// A sentence on the first term with derivatives, or their squares, that are
  /// not finite; empty: none.
  const std::string& NotFinite() const { return not_finite_; }

 private:
  class Guarded;

  void Caught(std::exception_ptr error);
  void Found(const std::string& term);

  std::mutex mutex_;
  std::exception_ptr error_;
  std::string not_finite_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_CERES_WATCH_H_
