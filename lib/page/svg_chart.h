#ifndef SPLITFUSION_LIB_PAGE_SVG_CHART_H_
#define SPLITFUSION_LIB_PAGE_SVG_CHART_H_

#include <string>
#include <vector>

namespace splitfusion {

/// One named row of values; NaN is a gap.
struct ChartSeries {
  std::string name;            ///< For the legend.
  std::vector<double> values;  ///< One per position on the horizontal axis.
  std::vector<double> spread =
      {};  ///< Half the height of error bars, or empty.
};

/// A small chart over frames, or over what has names.
struct Chart {
  std::string title;                ///< With the unit of the vertical axis.
  std::vector<ChartSeries> series;  ///< Of equal length.
  std::vector<int> marks;           ///< Positions marked red (lost frames).
  bool stacked = false;     ///< Areas on top of each other instead of lines.
  std::vector<int> frames;  ///< Index of every position, ascending; empty: the
                            ///< position itself.
  std::vector<std::string> names =
      {};                      ///< Of the positions, instead of frames.
  std::string axis = "frame";  ///< What the positions are.
};

/// The chart as one inline SVG element, 640 units wide: vertical axis from 0
/// to the largest value, ticks at frame indices, legend below. A chart without
/// values says so. Text has the colour of the page.
std::string SvgChart(const Chart& chart);

/// What happened at a position.
struct StripMark {
  int position = 0;  ///< Among the frames.
  std::string text;  ///< Shown when it is pointed at.
};

/// What holds over some frames, such as the state of a surface.
struct Strip {
  std::string name;                   ///< Left of it.
  std::vector<std::string> values;    ///< By position; empty: nothing.
  std::vector<StripMark> marks = {};  ///< Drawn over it.
};

/// Strips below one another over common frames, one colour a value in order of
/// `values`, as one inline SVG element with its legend.
std::string SvgStrips(const std::vector<Strip>& strips,
                      const std::vector<std::string>& values,
                      const std::vector<int>& frames);

/// An inline SVG element as a file of its own, text black.
std::string SvgFile(const std::string& element);

/// Colours of series, again from the first one on after the last.
std::vector<std::string> ChartColors();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_SVG_CHART_H_
