// SPDX-License-Identifier: AGPL-3.0-or-later
// What the loader of libraries accepts must be safe to feel. The input is read as a list of edits
// of a good library, of decoupled responses or (where bytes are left over, and those an odd number)
// of coupled ones, made behind the back of the writers; the file is then refused with an error of
// ours, or it is felt: pressed, slid and crossed, where every force must be finite and no energy
// may come out.
//
// Edits keep the file a HDF5 file: damage of the container itself is the business of the seal
// (tests/unit/format).
#include <hdf5.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "format/error.hpp"
#include "format/library.hpp"
#include "runtime/handles.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/hdf5_editor.hpp"

namespace palpate {
namespace {

using samples::Hdf5Editor;

struct Attribute {
  std::string object, name;
};

/// What there is to edit.
struct Targets {
  std::vector<std::string> datasets;
  std::vector<Attribute> attributes;  ///< numbers
  std::vector<Attribute> texts;       ///< the others: units, names, provenance
};

herr_t note_attribute(hid_t object, const char* name, const H5A_info_t*, void* targets) {
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT), type = H5Aget_type(attribute);
  const bool numeric = H5Tget_class(type) == H5T_FLOAT || H5Tget_class(type) == H5T_INTEGER;
  std::array<char, 256> path{};
  H5Iget_name(object, path.data(), path.size());
  auto* all = static_cast<Targets*>(targets);
  (numeric ? all->attributes : all->texts).push_back({path.data(), name});
  H5Tclose(type), H5Aclose(attribute);
  return 0;
}

herr_t note_object(hid_t file, const char* name, const H5O_info_t* info, void* data) {
  auto* targets = static_cast<Targets*>(data);
  const hid_t object = H5Oopen(file, name, H5P_DEFAULT);
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_attribute, data);
  if (info->type == H5O_TYPE_DATASET) {
    const hid_t type = H5Dget_type(object);
    if (H5Tget_class(type) != H5T_STRING) targets->datasets.emplace_back(name);
    H5Tclose(type);
  }
  H5Oclose(object);
  return 0;
}

Targets targets_of(const std::filesystem::path& golden) {
  Targets targets;
  const hid_t file = H5Fopen(golden.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, note_object, &targets);
  H5Fclose(file);
  return targets;
}

constexpr std::array<double, 16> kSpecial{0,
                                          -1,
                                          1,
                                          2,
                                          1e-320,
                                          -1e-9,
                                          1e-9,
                                          0.5,
                                          1e9,
                                          -1e300,
                                          1e308,
                                          4294967295.0,
                                          -0.0,
                                          3,
                                          std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::infinity()};

/// Thirteen bytes of the input.
struct Edit {
  std::uint8_t operation, target, special;
  std::uint16_t position;
  double value;
};
constexpr std::size_t kEditBytes = 13;
constexpr std::size_t kMostEdits = 8;

Edit edit_at(const std::uint8_t* bytes) {
  Edit edit{bytes[0], bytes[1], bytes[2], 0, 0};
  std::memcpy(&edit.position, bytes + 3, sizeof edit.position);
  std::memcpy(&edit.value, bytes + 5, sizeof edit.value);
  return edit;
}

/// One number of a dataset becomes change(number).
template <class Change>
void edit_number(hid_t file, const std::string& name, std::size_t position, Change&& change) {
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
  std::vector<double> all(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  if (!all.empty()) {
    double& number = all[position % all.size()];
    number = change(number);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  }
  H5Sclose(space), H5Dclose(dataset);
}

/// An attribute goes, or a text becomes another.
void edit_attribute(const Edit& edit, const Targets& targets, Hdf5Editor& editor) {
  const bool number = edit.special % 2 == 0;
  const std::vector<Attribute>& all = number ? targets.attributes : targets.texts;
  const auto& [object, name] = all[edit.position % all.size()];
  if (!editor.has_attribute(object, name)) return;
  if (number || edit.special % 4 == 1) return editor.remove_attribute(object, name);
  constexpr std::array<const char*, 4> kTexts{"mm", "N/mm", "", "1"};
  editor.set_text(object, name, kTexts[edit.target % kTexts.size()]);
}

void apply(const Edit& edit, const Targets& targets, Hdf5Editor& editor) {
  if (edit.operation >= 0xF0) return edit_attribute(edit, targets, editor);
  const std::string& dataset = targets.datasets[edit.target % targets.datasets.size()];
  const Attribute& attribute = targets.attributes[edit.target % targets.attributes.size()];
  const double special = kSpecial[edit.special % kSpecial.size()];
  if (edit.operation % 8 == 7) {
    if (!editor.has_attribute(attribute.object, attribute.name)) return;
    return editor.set_attribute(attribute.object, attribute.name, special, H5T_NATIVE_DOUBLE);
  }
  if (H5Lexists(editor.file(), dataset.c_str(), H5P_DEFAULT) <= 0) return;
  const auto change = [&](auto&& how) { edit_number(editor.file(), dataset, edit.position, how); };
  switch (edit.operation % 8) {
    case 0:
      return change([&](double) { return special; });
    case 1:
      return change([&](double) { return edit.value; });
    case 2:  // a little other
      return change([&](double x) { return x * (1 + (edit.special - 128) * 1e-4); });
    case 3:  // quite other
      return change([&](double x) { return x * (edit.special - 64) / 64.0; });
    case 4:
      return change([&](double x) { return x + edit.special - 128; });
    case 5:
      return editor.replace(dataset, {hsize_t{1} + edit.position % 40}, H5T_IEEE_F64LE, special);
    default:
      return editor.remove(dataset);
  }
}

void fail(const char* what) {
  std::fprintf(stderr, "fuzz_library: %s\n", what);
  std::abort();
}

/// Straight through the body from all sides, then along it.
void feel(const Library& library, const palpate_library& body) {
  runtime::ContactSettings settings;
  settings.friction =
      std::isfinite(library.certificate.friction) ? library.certificate.friction : 0.3;
  settings.lipschitz_bound = body.lipschitz_bound;
  palpate_state state(body, settings);
  Vec3 centre{}, span{};
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = 0.5 * (body.info.low[i] + body.info.high[i]);
    span[i] = body.info.high[i] - body.info.low[i];
  }
  const double reach = 0.05 + norm(span);
  double largest = 0;
  const auto step = [&](const Vec3& x) {
    state.step(x, 1e-3);
    const auto seen = state.observe();
    if (!std::isfinite(norm(state.command()))) fail("a force is not finite");
    largest = std::max(largest, std::abs(seen.energy));
    if (seen.absorbed < -1e-12 - 1e-9 * largest) fail("the body has given energy");
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (int k = 0; k <= 60; ++k) {
        Vec3 x = centre;
        x[axis] += side * reach * (1 - k / 30.0);
        x[(axis + 1) % 3] += 1e-4 * k;
        step(x);
      }
}

/// The golden library with responses that grow with depth: of schema 2.
void write_coupled(const std::filesystem::path& golden, const std::filesystem::path& file) {
  Library library = read_library(golden);
  library.kind = ResponseKind::Coupled;
  for (NodeResponse& node : library.responses)
    node.coupling = {0.3F, {{0.0F, 0.001F, 0.004F}, {0.0F, 200.0F, 100.0F}}};
  write_library(file, library);
}

/// A good library and what there is in it to edit.
struct Original {
  std::filesystem::path file;
  Targets targets;

  explicit Original(const std::filesystem::path& from) : file(from), targets(targets_of(from)) {
    if (targets.datasets.empty() || targets.attributes.empty() || targets.texts.empty())
      fail("no golden file");
  }
};

class Fuzzer {
 public:
  Fuzzer() : decoupled_(PALPATE_GOLDEN_LIBRARY), coupled_(made_coupled()) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }

  void run(const std::uint8_t* bytes, std::size_t size) {
    const Original& original = size % kEditBytes % 2 == 0 ? decoupled_ : coupled_;
    std::filesystem::copy_file(original.file, file_,
                               std::filesystem::copy_options::overwrite_existing);
    {
      Hdf5Editor editor(file_);
      for (std::size_t i = 0; i < kMostEdits && (i + 1) * kEditBytes <= size; ++i)
        apply(edit_at(bytes + i * kEditBytes), original.targets, editor);
    }
    Library library;
    std::unique_ptr<palpate_library> body;
    try {
      library = read_library(file_);
      body = std::make_unique<palpate_library>(library);
    } catch (const Error&) {
      return;
    }
    feel(library, *body);
    ++felt_;
  }

  int felt() const { return felt_; }

 private:
  std::filesystem::path made_coupled() const {
    const std::filesystem::path file = folder_ / "coupled.h5";
    write_coupled(PALPATE_GOLDEN_LIBRARY, file);
    return file;
  }

  samples::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "library.h5";
  Original decoupled_, coupled_;
  int felt_ = 0;
};

Fuzzer& fuzzer() {
  static Fuzzer one;
  return one;
}

}  // namespace
}  // namespace palpate

/// How many of the inputs made a library that was accepted.
extern "C" int inputs_felt() {
  return palpate::fuzzer().felt();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  palpate::fuzzer().run(bytes, size);
  return 0;
}
