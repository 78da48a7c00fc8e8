#ifndef SPLITFUSION_LIB_BASE_TEXT_FILE_H_
#define SPLITFUSION_LIB_BASE_TEXT_FILE_H_

#include <string>
#include <vector>

namespace splitfusion {

/// Text without the blanks around it.
std::string Trimmed(const std::string& text);

/// A line of a text file.
struct TextLine {
  std::string text;   ///< Trimmed().
  std::string place;  ///< "FILE:NUMBER", for messages.

  /// @throw InputError "FILE:NUMBER: 'TEXT': expected EXPECTED".
  [[noreturn]] void Refuse(const std::string& expected) const;
};

/// Lines of a file of the user's that are neither blank nor comments, which
/// begin with `#`; `cut_comments`: comments may follow other text, too. A pipe
/// is refused: it would be waited for, and be empty the second time.
///
/// @throw InputError if it cannot be opened, or is no regular file.
std::vector<TextLine> ReadTextLines(const std::string& path,
                                    bool cut_comments = false);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_TEXT_FILE_H_
