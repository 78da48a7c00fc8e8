#include "splitfusion/lib/energy/term_call.h"

#include <exception>
#include <stdexcept>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

// A signal handler can reach nothing else.
thread_local const TermCall* current = nullptr;

}  // namespace

TermCall::TermCall(const std::string& term, const char* part)
    : term_(term.c_str()), part_(part), outer_(current) {
  current = this;
}

TermCall::~TermCall() { current = outer_; }

const TermCall* TermCall::Current() { return current; }

void RethrowOfTerm(const std::string& term, const char* part) {
  const std::string where = "term '" + term + "', " + part + ": ";
  try {
    throw;
  } catch (const InputError& error) {
    throw InputError(where + error.what());
  } catch (const std::exception& error) {
    throw std::runtime_error(where + error.what());
  } catch (...) {
    throw std::runtime_error(where + "threw what is no std::exception");
  }
}

}  // namespace splitfusion
