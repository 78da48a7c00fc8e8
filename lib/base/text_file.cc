#include "splitfusion/lib/base/text_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

std::ifstream Open(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) &&
      !std::filesystem::is_regular_file(status)) {
    throw InputError(path + ": is no regular file: expected a text file");
  }
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be opened");
  return stream;
}

}  // namespace

std::string Trimmed(const std::string& text) {
  constexpr char kBlanks[] = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

void TextLine::Refuse(const std::string& expected) const {
  throw InputError(place + ": '" + text + "': expected " + expected);
}

std::vector<TextLine> ReadTextLines(const std::string& path,
                                    bool cut_comments) {
  std::ifstream stream = Open(path);
  std::vector<TextLine> lines;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (cut_comments) line.resize(std::min(line.find('#'), line.size()));
    const std::string text = Trimmed(line);
    if (text.empty() || text[0] == '#') continue;
    lines.push_back({text, path + ":" + std::to_string(number)});
  }
  return lines;
}

}  // namespace splitfusion
