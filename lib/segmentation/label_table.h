#ifndef SPLITFUSION_LIB_SEGMENTATION_LABEL_TABLE_H_
#define SPLITFUSION_LIB_SEGMENTATION_LABEL_TABLE_H_

#include <set>
#include <string>

namespace splitfusion {

/// How a class is treated (SplitFusion IV-A: "we treat humans and animals as
/// non-rigid, tables, grounds, and desktops as rigid").
enum class SurfaceKind { kRigid, kNonRigid };

/// Lower-case word for reports: "rigid" or "non_rigid".
std::string ToString(SurfaceKind kind);

/// Which class names are non-rigid; every other class is rigid.
class LabelTable {
 public:
  /// person, every COCO animal, teddy bear, umbrella, tie, and "object" (a
  /// mask without a class).
  LabelTable();

  /// Table from a text file: one class name a line, followed by a comma and
  /// `rigid` or `non_rigid`; `#` comments. Starts from the default table.
  ///
  /// @throw InputError on a missing file or a line that does not parse.
  static LabelTable FromFile(const std::string& path);

  /// Sets or changes how a class is treated.
  void Set(const std::string& class_name, SurfaceKind kind);
  /// How a class is treated; rigid if the table does not name it.
  SurfaceKind Kind(const std::string& class_name) const;

  /// Whether the table names the class, or COCO does.
  bool Knows(const std::string& class_name) const;

 private:
  std::set<std::string> non_rigid_;
  std::set<std::string> rigid_;  // Only those that were set so.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_LABEL_TABLE_H_
