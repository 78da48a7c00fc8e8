#include <filesystem>

#include "splitfusion/lib/sequence/calibration.h"
#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {
namespace {

/// Largest difference of the time stamps of a pair, seconds.
constexpr double kTimeTolerance = 0.02;

class TumFormat : public SequenceFormat {
 public:
  std::string Files() const override {
    return "associations.txt, or rgb.txt and depth.txt";
  }

  bool Recognises(const std::string& folder) const override {
    namespace fs = std::filesystem;
    for (const char* list : {"associations.txt", "rgb.txt", "depth.txt"}) {
      if (fs::exists(fs::path(folder) / list)) return true;
    }
    return false;
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& folder) const override {
    return FindAssociations(folder, kTimeTolerance);
  }
};

}  // namespace

std::unique_ptr<SequenceFormat> MakeTumFormat() {
  return std::make_unique<TumFormat>();
}

}  // namespace splitfusion
