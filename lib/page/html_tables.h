#ifndef SPLITFUSION_LIB_PAGE_HTML_TABLES_H_
#define SPLITFUSION_LIB_PAGE_HTML_TABLES_H_

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace splitfusion {

/// A heading of the third level.
std::string Heading(const std::string& text);

/// Rows of key and value; numbers are rounded for people.
std::string KeyTable(const nlohmann::ordered_json& object);

/// Objects, one a row; a column for every key that any of them has.
std::string RowTable(const nlohmann::ordered_json& rows);

/// What is shown only when it is asked for.
std::string Details(const std::string& title, const std::string& content);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_HTML_TABLES_H_
