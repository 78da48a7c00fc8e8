#ifndef SPLITFUSION_LIB_ENERGY_TERM_CALL_H_
#define SPLITFUSION_LIB_ENERGY_TERM_CALL_H_

#include <string>

namespace splitfusion {

/// Says, while it lives, that the code of a term runs on this thread: for what
/// ends the program from within, which no exception tells of.
class TermCall {
 public:
  /// `term` and `part` must outlive it; see CallTerm().
  TermCall(const std::string& term, const char* part);
  ~TermCall();
  TermCall(const TermCall&) = delete;             ///< Not copied.
  TermCall& operator=(const TermCall&) = delete;  ///< Not copied.

  /// The innermost one of this thread; null: no term runs. May be called by a
  /// signal handler.
  static const TermCall* Current();

  /// Registered name of the term.
  const char* term() const { return term_; }
  /// What of it runs.
  const char* part() const { return part_; }

 private:
  const char* term_;
  const char* part_;
  const TermCall* outer_;
};

/// Throws what is being thrown again, as an InputError if it is one, otherwise
/// as a std::runtime_error: "term 'NAME', PART: ...". Call it in a handler.
[[noreturn]] void RethrowOfTerm(const std::string& term, const char* part);

/// Calls what a term has written, and names the term in whatever that throws.
/// `part`: what is called, as in "AddResiduals()".
template <typename Body>
auto CallTerm(const std::string& term, const char* part, const Body& body) {
  const TermCall call(term, part);
  try {
    return body();
  } catch (...) {
    RethrowOfTerm(term, part);
  }
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_CALL_H_
