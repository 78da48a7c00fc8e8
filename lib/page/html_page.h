#ifndef SPLITFUSION_LIB_PAGE_HTML_PAGE_H_
#define SPLITFUSION_LIB_PAGE_HTML_PAGE_H_

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/page/run_scene.h"
#include "splitfusion/lib/page/svg_chart.h"

namespace splitfusion {

/// Collects one self-contained page. It loads nothing, and its
/// Content-Security-Policy lets through its own style and programs alone, by
/// their hashes.
class HtmlPage {
 public:
  /// Adds HTML as it is.
  void Add(const std::string& html) { body_ += html; }

  /// Adds a chart: a drawing that needs no program, and the values from which
  /// the page's program draws one that can be zoomed. `group`: charts over the
  /// frames of the same run show the same frame under the pointer; empty: the
  /// axis has no frames.
  void AddChart(const Chart& chart, const std::string& group);

  /// Adds a viewer, or a line that says why there is none. `group`: of the
  /// charts over its frames.
  void AddViewer(const RunScene& scene, const std::string& group);

  /// The whole page.
  std::string Text() const;

 private:
  std::string body_;
  nlohmann::ordered_json charts_ = nlohmann::ordered_json::array();
  std::map<std::vector<int>, int> places_;  // Axes, and their order.
  bool has_viewer_ = false;
};

/// Text with the characters special to HTML replaced.
std::string HtmlEscaped(const std::string& text);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_HTML_PAGE_H_
