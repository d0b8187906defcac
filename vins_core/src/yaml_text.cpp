#include "vins_core/yaml_text.h"

#include <cstdio>
#include <cstdlib>

namespace vins {

std::string exactNumber(double value) {
  char text[32];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof(text), "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  const std::string plain = text;
  return plain.find_first_of(".en") == std::string::npos ? plain + ".0" : plain;
}

std::string opencvMatrix(const std::string& key, const Eigen::MatrixXd& matrix) {
  std::string data;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      const bool is_new_row = column == 0 && row > 0;
      data += (data.empty() ? ""
               : is_new_row ? ",\n          "
                            : ", ") +
              exactNumber(matrix(row, column));
    }
  }
  return key + ": !!opencv-matrix\n   rows: " + std::to_string(matrix.rows()) +
         "\n   cols: " + std::to_string(matrix.cols()) + "\n   dt: d\n   data: [" + data + "]\n";
}

}  // namespace vins
