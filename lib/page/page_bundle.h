#ifndef SPLITFUSION_LIB_PAGE_PAGE_BUNDLE_H_
#define SPLITFUSION_LIB_PAGE_PAGE_BUNDLE_H_

#include <string_view>

namespace splitfusion {

/// Something inline of report pages, made from `app/` when the project is built
/// (cmake/PageBundle.cmake).
struct PagePart {
  std::string_view text;    ///< Empty: there was no node to make it.
  std::string_view sha256;  ///< Of the text, 64 hexadecimal digits.
};

/// CSS.
PagePart PageStyle();
/// JavaScript that draws charts which can be zoomed.
PagePart ChartProgram();
/// JavaScript that plays the surfaces of a run.
PagePart ViewerProgram();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_PAGE_BUNDLE_H_
