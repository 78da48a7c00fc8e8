#ifndef SPLITFUSION_LIB_REPORT_ITERATIONS_CSV_H_
#define SPLITFUSION_LIB_REPORT_ITERATIONS_CSV_H_

#include <ostream>

#include "splitfusion/lib/report/frame_report.h"

namespace splitfusion {

/// Writes the header line of `iterations.csv`; docs/report_format.md explains
/// the columns.
void WriteIterationsHeader(std::ostream& out);

/// Writes one row for every solver iteration of the frame. Numbers are the
/// shortest that read back exactly, whatever the locale; NaN and infinity are
/// empty fields.
void WriteIterations(std::ostream& out, const FrameReport& report);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_ITERATIONS_CSV_H_
