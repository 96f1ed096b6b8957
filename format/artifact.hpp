// SPDX-License-Identifier: Apache-2.0
// What all artifacts have in common on disk: the root attributes and the provenance.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "format/checks.hpp"
#include "format/hdf5_file.hpp"
#include "format/provenance.hpp"

namespace palpate {

/// Kind of an artifact, "palpate.<kind>". A flat library is a library.
/// @throws Error(Configuration) where the file is no artifact, with `remedy`.
std::string artifact_kind(const std::filesystem::path& file, const std::string& remedy);

/// The attribute `schema` of an artifact, the version of a flat library. @throws as artifact_kind.
std::int64_t schema_of_file(const std::filesystem::path& file, const std::string& remedy);

/// Root attributes `artifact`, `schema`, `description`, `creator`.
void write_root(hdf5::Writer& writer, const std::string& artifact, int schema,
                const std::string& description);

/// Group /provenance with one group <NN>_<stage> per step.
void write_provenance(hdf5::Writer& writer, const Provenance& provenance);
Provenance read_provenance(const hdf5::Reader& reader);

}  // namespace palpate
