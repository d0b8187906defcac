#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vins_core/time.h"

namespace vins::pipeline {

/// One line of a csv file: a stamp and the fields behind it, without surrounding blanks.
struct CsvRow {
  Stamp stamp = 0;  ///< [ns]
  std::vector<std::string> fields;

  /// Field i as a finite number; InputError (without file and line) where it is none.
  double number(std::size_t i) const;
};

/// Hands each row of the file to `use`; lines that are empty or begin with '#' are passed over.
/// Throws InputError "FILE:LINE: ..." where a row has fewer than `field_count` fields behind its
/// stamp, a stamp is no whole number or does not rise, or `use` throws; and where no row is there.
void readCsvFile(const std::string& path, std::size_t field_count,
                 const std::function<void(const CsvRow&)>& use);

}  // namespace vins::pipeline
