#include "splitfusion/lib/experiment/result_files.h"

#include <sqlite3.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <utility>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/csv_row.h"

namespace splitfusion {
namespace {

std::vector<std::string> Columns(std::vector<std::string> first,
                                 const ResultTable& table) {
  first.insert(first.end(), table.keys.begin(), table.keys.end());
  return first;
}

std::vector<Cell> Cells(std::vector<Cell> first,
                        const std::vector<std::string>& values) {
  first.insert(first.end(), values.begin(), values.end());
  return first;
}

std::string CsvLine(const std::vector<std::string>& fields) {
  CsvRow row;
  for (const std::string& field : fields) row.Add(field);
  return row.text() + "\n";
}

/// Closes a database.
struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

/// Releases a statement.
struct Finalize {
  void operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
  }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

void Check(int code, int wanted, sqlite3* database) {
  if (code == wanted) return;
  throw InputError(std::string("cannot be written by SQLite (") +
                   sqlite3_errmsg(database) + ")");
}

void Execute(sqlite3* database, const std::string& sql) {
  Check(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr),
        SQLITE_OK, database);
}

Statement Prepare(sqlite3* database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  Check(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr),
        SQLITE_OK, database);
  return Statement(statement);
}

/// A name as SQL wants it: "terms.arap.weight".
std::string Identifier(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

void Bind(sqlite3* database, sqlite3_stmt* statement, int place,
          const Cell& cell) {
  const int code =
      cell.is_count
          ? sqlite3_bind_int64(statement, place, static_cast<int>(cell.number))
      : cell.is_number ? sqlite3_bind_double(statement, place, cell.number)
      : cell.text.empty()
          ? sqlite3_bind_null(statement, place)
          : sqlite3_bind_text(statement, place, cell.text.c_str(), -1,
                              SQLITE_TRANSIENT);
  Check(code, SQLITE_OK, database);
}

/// Frames are counted, everything else is measured.
Cell FigureCell(const std::string& name, double value) {
  const bool is_count = name == "frames" || name == "lost_frames";
  return is_count && std::isfinite(value) ? Cell(static_cast<int>(value))
                                          : Cell(value);
}

void InsertTable(sqlite3* database, const FileTable& table) {
  std::string columns, places;
  for (const std::string& column : table.columns) {
    columns += (columns.empty() ? "" : ", ") + Identifier(column);
    places += places.empty() ? "?" : ", ?";
  }
  const std::string name = Identifier(table.name);
  Execute(database, "CREATE TABLE " + name + " (" + columns + ")");
  const Statement insert =
      Prepare(database, "INSERT INTO " + name + " VALUES (" + places + ")");
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      Bind(database, insert.get(), static_cast<int>(i) + 1, row[i]);
    }
    Check(sqlite3_step(insert.get()), SQLITE_DONE, database);
    sqlite3_reset(insert.get());
  }
}

void WriteDatabase(const std::string& path,
                   const std::vector<FileTable>& tables) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);  // Of a process that was killed.
  sqlite3* opened = nullptr;
  const int code = sqlite3_open(path.c_str(), &opened);
  const Database database(opened);
  Check(code, SQLITE_OK, opened);
  // The file is new and takes its name when it is whole: it needs no journal.
  Execute(opened, "PRAGMA journal_mode = OFF");
  Execute(opened, "BEGIN");
  for (const FileTable& table : tables) InsertTable(opened, table);
  Execute(opened, "COMMIT");
}

/// Groups of a comparison; columns of means have this suffix.
FileTable ComparisonTable(const std::string& name, const std::string& suffix,
                          const ResultTable& table,
                          const std::vector<ResultGroup>& groups) {
  FileTable file{name, Columns({"sequence"}, table), {}};
  for (const char* column : {"n", "seconds_per_run"}) {
    file.columns.emplace_back(column);
  }
  for (const std::string figure : kFigureNames) {
    file.columns.push_back(figure + suffix);
    file.columns.push_back(figure + "_se");
  }
  for (const ResultGroup& group : groups) {
    std::vector<Cell> cells = Cells({group.sequence}, group.values);
    cells.emplace_back(group.runs);
    cells.emplace_back(group.seconds.mean);
    for (const Spread& spread : group.figures) {
      cells.emplace_back(spread.mean);
      cells.emplace_back(spread.StandardError());
    }
    file.rows.push_back(std::move(cells));
  }
  return file;
}

}  // namespace

Cell::Cell(std::string value) : text(std::move(value)) {
  char* end = nullptr;
  number = std::strtod(text.c_str(), &end);
  const bool decimal =
      text.find_first_not_of("+-.0123456789eE") == std::string::npos;
  is_number = decimal && !text.empty() && *end == '\0' && std::isfinite(number);
}

Cell::Cell(double value) : is_number(std::isfinite(value)), number(value) {
  CsvRow row;
  row.Add(value);
  text = row.text();
}

Cell::Cell(int value) : Cell(static_cast<double>(value)) { is_count = true; }

FileTable ResultsTable(const ResultTable& table) {
  FileTable file{
      "results", Columns({"task", "sequence", "repeat", "status"}, table), {}};
  for (const char* name : kFigureNames) file.columns.emplace_back(name);
  for (const ResultRow& row : table.rows) {
    std::vector<Cell> cells =
        Cells({row.task.name, row.task.sequence, row.task.repeat, row.status},
              row.values);
    for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
      cells.push_back(FigureCell(kFigureNames[i], row.figures.values[i]));
    }
    file.rows.push_back(std::move(cells));
  }
  return file;
}

FileTable SummaryTable(const ResultTable& table,
                       const std::vector<ResultGroup>& groups) {
  FileTable file{"summary", Columns({"sequence"}, table), {}};
  for (const char* name : {"n", "planned"}) file.columns.emplace_back(name);
  for (const std::string name : kFigureNames) {
    file.columns.push_back(name + "_mean");
    file.columns.push_back(name + "_sd");
  }
  for (const ResultGroup& group : groups) {
    std::vector<Cell> cells = Cells({group.sequence}, group.values);
    cells.emplace_back(group.runs);
    cells.emplace_back(group.planned);
    for (const Spread& spread : group.figures) {
      cells.emplace_back(spread.mean);
      cells.emplace_back(spread.standard_deviation);
    }
    file.rows.push_back(std::move(cells));
  }
  return file;
}

FileTable DifferencesTable(const ResultTable& table,
                           const Comparison& comparison) {
  return ComparisonTable("differences", "_difference", table,
                         comparison.groups);
}

FileTable EffectsTable(const ResultTable& table, const Comparison& comparison) {
  return ComparisonTable("effects", "_effect", table, comparison.effects);
}

void WriteCsv(const std::string& path, const FileTable& table) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << CsvLine(table.columns);
    for (const std::vector<Cell>& row : table.rows) {
      std::vector<std::string> fields;
      fields.reserve(row.size());
      for (const Cell& cell : row) fields.push_back(cell.text);
      out << CsvLine(fields);
    }
  });
}

void WriteSqlite(const std::string& path,
                 const std::vector<FileTable>& tables) {
  WritePathAtomically(path, [&](const std::string& temporary) {
    try {
      WriteDatabase(temporary, tables);
    } catch (const InputError& error) {
      throw InputError(path + ": " + error.what());
    }
  });
}

}  // namespace splitfusion
