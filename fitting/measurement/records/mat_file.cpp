// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/mat_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>

#include "format/error.hpp"
#include "format/matrix_path.hpp"

#ifdef PALPATE_HAS_MATIO
#include <matio.h>
#endif

namespace palpate::measured {

bool is_mat_file(const std::filesystem::path& file) {
  constexpr std::string_view mark = "MATLAB 5.0 MAT-file";
  std::array<char, mark.size()> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  return std::string_view(head.data(), head.size()) == mark || file.extension() == ".mat";
}

#ifndef PALPATE_HAS_MATIO

std::vector<double> read_mat_column(const std::filesystem::path& file, const std::string&) {
  refuse(file.string(), "this palpate was built without libmatio, which reads MAT files",
         "install libmatio-dev and build again, or save the file with -v7.3");
}

#else

namespace {

struct CloseFile {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using File = std::unique_ptr<mat_t, CloseFile>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

void say_nothing(int, char*) {}

/// One step into a variable: a field, the element of an array of structs, or a cell.
struct Step {
  enum Kind { Field, Element, Cell } kind = Field;
  std::string field;
  std::size_t index = 0;  ///< from 0
};

[[noreturn]] void refuse_path(const std::string& where) {
  refuse(where, "it is no path of MATLAB", "write for example run(2).force or runs{2}.force");
}

std::size_t index_of(std::string_view text, const std::string& where) {
  std::size_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size() || value < 1) refuse_path(where);
  return value - 1;
}

/// "run(2).press{3}" as the name of a variable and steps; slashes separate as dots do.
std::vector<Step> steps_of(std::string_view path, const std::string& where) {
  std::vector<Step> steps;
  path.remove_prefix(std::min(path.find_first_not_of("./"), path.size()));
  while (!path.empty()) {
    const char open = path.front();
    if (open == '(' || open == '{') {
      const std::size_t close = path.find(open == '(' ? ')' : '}');
      if (close == std::string_view::npos || steps.empty()) refuse_path(where);
      steps.push_back({open == '(' ? Step::Element : Step::Cell, "",
                       index_of(path.substr(1, close - 1), where)});
      path.remove_prefix(close + 1);
      continue;
    }
    if (open == '.' || open == '/') path.remove_prefix(1);
    const std::size_t end = std::min(path.find_first_of("./({"), path.size());
    if (end == 0) refuse_path(where);
    steps.push_back({Step::Field, std::string(path.substr(0, end)), 0});
    path.remove_prefix(end);
  }
  if (steps.empty()) refuse_path(where);
  return steps;
}

std::string variables_of(mat_t* file) {
  std::size_t count = 0;
  char** const names = Mat_GetDir(file, &count);  // belongs to the file
  std::string text;
  for (std::size_t i = 0; names != nullptr && i < count; ++i)
    text += (text.empty() ? "'" : ", '") + std::string(names[i]) + "'";
  return text.empty() ? "nothing" : text;
}

std::string fields_of(const matvar_t& variable) {
  char* const* names = Mat_VarGetStructFieldnames(&variable);
  std::string text;
  const unsigned count = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&variable));
  for (unsigned i = 0; names != nullptr && i < count; ++i)
    text += (text.empty() ? "'" : ", '") + std::string(names[i]) + "'";
  return text.empty() ? "nothing" : text;
}

std::size_t count_of(const matvar_t& variable) {
  std::size_t count = 1;
  for (int i = 0; i < variable.rank; ++i) {
    if (variable.dims[i] > 0 && count > SIZE_MAX / variable.dims[i]) return SIZE_MAX;
    count *= variable.dims[i];
  }
  return count;
}

void check_index(const matvar_t& variable, std::size_t index, const std::string& where) {
  if (index < count_of(variable)) return;
  refuse(where,
         "there is no element " + std::to_string(index + 1) + ", the array has " +
             std::to_string(count_of(variable)),
         "count from 1");
}

/// The variable that the steps lead to; it belongs to the first one.
matvar_t* follow(matvar_t* variable, const std::vector<Step>& steps, const std::string& where) {
  std::size_t element = 0;
  bool chosen = false;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Step& step = steps[i];
    if (step.kind == Step::Element) {
      check_index(*variable, step.index, where);
      if (variable->class_type != MAT_C_STRUCT) refuse_path(where);
      element = step.index;
      chosen = true;
      continue;
    }
    matvar_t* next = nullptr;
    if (step.kind == Step::Cell) {
      if (variable->class_type != MAT_C_CELL)
        refuse(where, "what the braces index is no cell array", "index structs with parentheses");
      check_index(*variable, step.index, where);
      next = Mat_VarGetCell(variable, static_cast<int>(step.index));
    } else {
      if (variable->class_type != MAT_C_STRUCT)
        refuse(where, "what has the field '" + step.field + "' is no struct",
               "name a variable, or a field of a struct");
      if (!chosen && count_of(*variable) > 1)
        refuse(where, "it is an array of " + std::to_string(count_of(*variable)) + " structs",
               "choose one, as in run(2)." + step.field);
      check_index(*variable, element, where);
      next = Mat_VarGetStructFieldByName(variable, step.field.c_str(), element);
      if (next == nullptr)
        refuse(where, "there is no field '" + step.field + "'",
               "the struct has " + fields_of(*variable));
    }
    if (next == nullptr) refuse(where, "it is empty", "name what holds numbers");
    variable = next;
    element = 0;
    chosen = false;
  }
  return variable;
}

template <class T>
std::vector<double> as_doubles(const matvar_t& variable) {
  const auto* first = static_cast<const T*>(variable.data);
  return {first, first + count_of(variable)};
}

std::optional<std::vector<double> > numbers_of(const matvar_t& variable) {
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      return as_doubles<double>(variable);
    case MAT_T_SINGLE:
      return as_doubles<float>(variable);
    case MAT_T_INT8:
      return as_doubles<std::int8_t>(variable);
    case MAT_T_UINT8:
      return as_doubles<std::uint8_t>(variable);
    case MAT_T_INT16:
      return as_doubles<std::int16_t>(variable);
    case MAT_T_UINT16:
      return as_doubles<std::uint16_t>(variable);
    case MAT_T_INT32:
      return as_doubles<std::int32_t>(variable);
    case MAT_T_UINT32:
      return as_doubles<std::uint32_t>(variable);
    default:
      return std::nullopt;
  }
}

void check_class(const matvar_t& variable, const std::string& where) {
  const matio_classes kind = variable.class_type;
  if (kind == MAT_C_STRUCT)
    refuse(where, "it is a struct", "name one of its fields: " + fields_of(variable));
  if (kind == MAT_C_CELL) refuse(where, "it is a cell array", "choose a cell, as in runs{2}");
  if (kind == MAT_C_CHAR) refuse(where, "it holds text", "name what holds numbers");
  if (kind == MAT_C_OBJECT || kind == MAT_C_OPAQUE || kind == MAT_C_FUNCTION)
    refuse(where, "it is an object of MATLAB, as tables are",
           "store its columns as plain arrays (table2struct with 'ToScalar')");
  if (kind == MAT_C_SPARSE || variable.isComplex != 0)
    refuse(where, "it holds sparse or complex numbers", "store a full, real array");
}

/// Whole numbers of 64 bits and what is not numbers at all have been sorted out before.
std::vector<double> checked_numbers(const matvar_t& variable, const std::string& where) {
  check_class(variable, where);
  const std::size_t count = count_of(variable);
  if (count == 0) refuse(where, "it is empty", "name what holds numbers");
  const std::size_t size = Mat_SizeOf(variable.data_type);
  const bool is_whole = variable.data != nullptr && size > 0 && variable.nbytes / size >= count;
  if (!is_whole)
    refuse(where, "its numbers cannot be read", "the file may be cut off: copy it again");
  auto numbers = numbers_of(variable);
  if (!numbers) refuse(where, "its kind of numbers is not read", "store it as double");
  return *std::move(numbers);
}

/// The column or row of a matrix that the path chooses.
std::vector<double> chosen_of(const std::vector<double>& numbers, const matvar_t& variable,
                              const MatrixPath& path, const std::string& where) {
  const std::size_t rows = variable.rank >= 1 ? variable.dims[0] : 1;
  const std::size_t columns = rows > 0 ? numbers.size() / rows : 0;
  if (!path.chosen()) {
    if (rows == numbers.size() || columns == numbers.size()) return numbers;
    refuse(where, "it is a matrix, not a column", "choose a column: " + path.base + "(:,1)");
  }
  if (variable.rank != 2) refuse(where, "it is no matrix", "name a matrix of rows and columns");
  const bool column = path.column > 0;
  const auto index = static_cast<std::size_t>(column ? path.column : path.row) - 1;
  const std::size_t across = column ? columns : rows;
  if (index >= across)
    refuse(where,
           "there is no " + std::string(column ? "column " : "row ") + std::to_string(index + 1) +
               ", the matrix has " + std::to_string(across),
           "count from 1");
  std::vector<double> values;
  for (std::size_t i = 0; i < (column ? rows : columns); ++i)
    values.push_back(numbers[column ? index * rows + i : i * rows + index]);
  return values;
}

}  // namespace

std::vector<double> read_mat_column(const std::filesystem::path& file, const std::string& path) {
  const std::string where = file.string() + ", '" + path + "'";
  Mat_LogInitFunc("palpate", say_nothing);
  const File opened(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (!opened)
    refuse(file.string(), "the MAT file cannot be opened",
           "it may be cut off or be of another kind: copy it again, or save it with -v7");
  const MatrixPath parsed = matrix_path(path, where);
  const std::vector<Step> steps = steps_of(parsed.base, where);
  const Variable variable(Mat_VarRead(opened.get(), steps[0].field.c_str()));
  if (!variable)
    refuse(where, "the file has no variable '" + steps[0].field + "', or it is cut off there",
           "the file holds " + variables_of(opened.get()));
  const matvar_t& found = *follow(variable.get(), steps, where);
  std::vector<double> values = chosen_of(checked_numbers(found, where), found, parsed, where);
  check_finite(values, where);
  return values;
}

#endif

}  // namespace palpate::measured
