#ifndef SPLITFUSION_TESTS_SUPPORT_SAMPLE_REPORT_H_
#define SPLITFUSION_TESTS_SUPPORT_SAMPLE_REPORT_H_

#include "splitfusion/lib/report/frame_report.h"

namespace splitfusion {

/// A report of a frame with every list filled: the background and one person,
/// each with one round of two iterations.
FrameReport SampleReport(int frame);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_SAMPLE_REPORT_H_
