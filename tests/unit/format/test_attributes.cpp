// SPDX-License-Identifier: AGPL-3.0-or-later
// Every attribute of every artifact is needed, and units are believed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/breakage.hpp"

namespace palpate::samples {
namespace {

/// Every attribute of a file, as (object, name).
using AttributeList = std::vector<std::pair<std::string, std::string>>;

herr_t note_attribute(hid_t object, const char* name, const H5A_info_t*, void* list) {
  std::array<char, 256> path{};
  H5Iget_name(object, path.data(), path.size());
  static_cast<AttributeList*>(list)->emplace_back(path.data(), name);
  return 0;
}
herr_t note_object(hid_t file, const char* name, const H5O_info_t*, void* list) {
  const hid_t object = H5Oopen(file, name, H5P_DEFAULT);
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_attribute, list);
  H5Oclose(object);
  return 0;
}
AttributeList attributes_of(const Path& path) {
  AttributeList list;
  const Hdf5Editor editor(path);
  H5Ovisit(editor.file(), H5_INDEX_NAME, H5_ITER_INC, note_object, &list);
  return list;
}

/// What a reader may do without: texts for people, and what later versions added.
bool may_be_missing(const std::string& name) {
  for (const char* optional :
       {"description", "creator", "basis", "min_lipschitz_bound", "lipschitz_bound",
        "tool_edge_radius", "tool_length", "mesh_error_confidence"})
    if (name == optional) return true;
  return false;
}

/// Texts have no units to speak of.
bool is_texts(const std::string& dataset) {
  return dataset == "/region_names" || dataset == "/site/reason" ||
         dataset == "/certificate/device/name";
}

class EveryAttribute : public testing::TestWithParam<Kind> {
 protected:
  /// The refusal of the sample after this change; empty when it was accepted.
  std::string refusal(const std::function<void(Hdf5Editor&)>& change) const {
    const Path path = folder_ / "artifact.h5";
    copy_sample(GetParam(), path);
    edit(change)(path);
    try {
      read_sample(GetParam(), path);
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error.what();
    }
    return "";
  }
  AttributeList attributes() const {
    copy_sample(GetParam(), folder_ / "artifact.h5");
    return attributes_of(folder_ / "artifact.h5");
  }

  const TemporaryFolder folder_;
};

TEST_P(EveryAttribute, IsMissed) {
  int tried = 0;
  for (const auto& [object, name] : attributes()) {
    const bool is_text_list = is_texts(object);
    if (may_be_missing(name) || (is_text_list && name == "units")) continue;
    const std::string said =
        refusal([&, o = object, n = name](Hdf5Editor& editor) { editor.remove_attribute(o, n); });
    EXPECT_THAT(said, testing::HasSubstr(object)) << name;
    EXPECT_THAT(said, testing::HasSubstr(name)) << object;
    ++tried;
  }
  EXPECT_GT(tried, 20);
}

TEST_P(EveryAttribute, OfUnitsIsBelieved) {
  // Millimetres read as metres would be a body a thousand times as large.
  int tried = 0;
  for (const auto& [object, name] : attributes()) {
    const bool is_text_list = is_texts(object);
    if (name != "units" || is_text_list) continue;
    const std::string said =
        refusal([o = object](Hdf5Editor& editor) { editor.set_text(o, "units", "mm"); });
    EXPECT_THAT(said, testing::HasSubstr(object + "@units"));
    ++tried;
  }
  EXPECT_GT(tried, 8);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryAttribute,
                         testing::Values(Kind::Body, Kind::Curves, Kind::Library,
                                         Kind::CoupledLibrary, Kind::Recording));

}  // namespace
}  // namespace palpate::samples
