# Test: list_constants prints the constants of the method, one a line, and
# nothing else.
#   cmake -D WORK_DIR=... -P list_constants_finds_them.cmake
file(REMOVE_RECURSE "${WORK_DIR}")
file(WRITE "${WORK_DIR}/lib/split/a.h" [[
struct AOptions {
  double reached = 0.1;
  double hidden = 1;
  void List(OptionList* list);
};
class A {
  int count_ = 0;
  int frames_ = 30;
};
]])
file(WRITE "${WORK_DIR}/lib/split/a.cc" [[
constexpr float kReach = 0.45f;  // Metres.
constexpr int kTile = 16;        // Speed: pixels.
constexpr double kDerived = 2 * kReach;
constexpr double kLevels[2] = {1.2,
                               4.0};
void AOptions::List(OptionList* list) {
  list->Number("reached", &reached, {0.2, 0.7}, "", "No 0.3.");
}
double Gate(double z) {
  // Not 0.9.
  if (z < 1e-12) return 0.5;
  return 0.02 + 2 * z;
}
]])
file(WRITE "${WORK_DIR}/cost_functions/c.h" [[
class Term : public EnergyTerm {
 public:
  void List(OptionList* list) override {
    list->Number("metres", &metres_, {0.2, 0.7}, "", "");
  }

 private:
  double metres_ = 0.05;
  double unlisted_ = 0.06;
};
]])
file(WRITE "${WORK_DIR}/lib/report/b.cc" "constexpr int kWidth = 640;\n")
execute_process(
  COMMAND "${CMAKE_CURRENT_LIST_DIR}/../../tools/list_constants.sh"
          "${WORK_DIR}"
  RESULT_VARIABLE result OUTPUT_VARIABLE output)
set(expected "cost_functions/c.h:9 unlisted_ = 0.06
lib/split/a.cc:1 kReach = 0.45f
lib/split/a.cc:4 kLevels = {1.2, 4.0}
lib/split/a.cc:12 Gate = 0.02
lib/split/a.h:3 hidden = 1
lib/split/a.h:8 frames_ = 30
")
if(NOT result EQUAL 0 OR NOT output STREQUAL expected)
  message(FATAL_ERROR "exit ${result}:\n${output}expected:\n${expected}")
endif()
