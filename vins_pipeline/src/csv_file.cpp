#include "csv_file.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "vins_core/input_error.h"

namespace vins::pipeline {
namespace {

std::string withoutBlanks(const std::string& text) {
  const char* blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> splitAtCommas(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  for (std::size_t comma = line.find(','); comma != std::string::npos;
       comma = line.find(',', begin)) {
    fields.push_back(withoutBlanks(line.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  fields.push_back(withoutBlanks(line.substr(begin)));
  return fields;
}

Stamp parseStamp(const std::string& text) {
  // 18 digits are the year 2001, 19 reach to 2262, where the numbers end.
  const bool digits_only = text.find_first_not_of("0123456789") == std::string::npos;
  if (text.empty() || !digits_only || text.size() > 19 || (text.size() == 19 && text[0] == '9')) {
    throw InputError("found '" + text + "' where a stamp in whole nanoseconds is needed");
  }
  return std::stoll(text);
}

CsvRow parseRow(const std::string& line, std::size_t field_count) {
  CsvRow row;
  row.fields = splitAtCommas(line);
  row.stamp = parseStamp(row.fields.front());
  row.fields.erase(row.fields.begin());
  if (row.fields.size() < field_count) {
    throw InputError("found " + std::to_string(row.fields.size()) + " values behind the stamp; " +
                     std::to_string(field_count) + " are needed");
  }
  return row;
}

void requireRising(const std::optional<Stamp>& before, Stamp stamp) {
  if (!before || stamp > *before) return;
  throw InputError("stamp " + std::to_string(stamp) + " ns follows " + std::to_string(*before) +
                   " ns; stamps must rise");
}

}  // namespace

double CsvRow::number(std::size_t i) const {
  char* end = nullptr;
  const double value = std::strtod(fields[i].c_str(), &end);
  if (fields[i].empty() || *end != '\0' || !std::isfinite(value)) {
    throw InputError("found '" + fields[i] + "' where a finite number is needed");
  }
  return value;
}

void readCsvFile(const std::string& path, std::size_t field_count,
                 const std::function<void(const CsvRow&)>& use) {
  std::ifstream in(path);
  if (!in) throw InputError(path + ": cannot be opened for reading");
  std::optional<Stamp> before;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string text = withoutBlanks(line);
    if (text.empty() || text[0] == '#') continue;
    try {
      const CsvRow row = parseRow(text, field_count);
      requireRising(before, row.stamp);
      use(row);
      before = row.stamp;
    } catch (const InputError& error) {
      throw InputError(path + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (!before) throw InputError(path + ": no data in it");
}

}  // namespace vins::pipeline
