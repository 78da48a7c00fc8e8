#include "splitfusion/lib/segmentation/label_table.h"

#include <algorithm>
#include <vector>

#include "splitfusion/lib/base/text_file.h"
#include "splitfusion/lib/segmentation/class_names.h"

namespace splitfusion {
namespace {

/// Applies one line `class, kind`; false if it does not parse.
bool ApplyLine(const std::string& line, LabelTable* table) {
  const std::size_t comma = line.rfind(',');
  if (comma == std::string::npos) return false;
  const std::string class_name = Trimmed(line.substr(0, comma));
  const std::string kind = Trimmed(line.substr(comma + 1));
  if (class_name.empty()) return false;
  if (kind != "rigid" && kind != "non_rigid") return false;
  table->Set(class_name,
             kind == "rigid" ? SurfaceKind::kRigid : SurfaceKind::kNonRigid);
  return true;
}

}  // namespace

std::string ToString(SurfaceKind kind) {
  return kind == SurfaceKind::kRigid ? "rigid" : "non_rigid";
}

LabelTable::LabelTable()
    : non_rigid_{"person",  "bird",       "cat",      "dog",  "horse",
                 "sheep",   "cow",        "elephant", "bear", "zebra",
                 "giraffe", "teddy bear", "umbrella", "tie",  "object"} {}

LabelTable LabelTable::FromFile(const std::string& path) {
  LabelTable table;
  for (const TextLine& line : ReadTextLines(path, /*cut_comments=*/true)) {
    if (ApplyLine(line.text, &table)) continue;
    line.Refuse("'class name, rigid' or 'class name, non_rigid'");
  }
  return table;
}

void LabelTable::Set(const std::string& class_name, SurfaceKind kind) {
  const bool is_rigid = kind == SurfaceKind::kRigid;
  (is_rigid ? rigid_ : non_rigid_).insert(class_name);
  (is_rigid ? non_rigid_ : rigid_).erase(class_name);
}

bool LabelTable::Knows(const std::string& class_name) const {
  const std::vector<std::string>& coco = CocoClassNames();
  return non_rigid_.count(class_name) > 0 || rigid_.count(class_name) > 0 ||
         std::find(coco.begin(), coco.end(), class_name) != coco.end();
}

SurfaceKind LabelTable::Kind(const std::string& class_name) const {
  return non_rigid_.count(class_name) > 0 ? SurfaceKind::kNonRigid
                                          : SurfaceKind::kRigid;
}

}  // namespace splitfusion
