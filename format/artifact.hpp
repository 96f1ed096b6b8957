// SPDX-License-Identifier: Apache-2.0
// What all artifacts have in common on disk: the root attributes and the provenance.
#pragma once

#include <string>

#include "format/checks.hpp"
#include "format/hdf5_file.hpp"
#include "format/provenance.hpp"

namespace palpate {

/// Root attributes `artifact`, `schema`, `description`, `creator`.
void write_root(hdf5::Writer& writer, const std::string& artifact, int schema,
                const std::string& description);

/// Group /provenance with one group <NN>_<stage> per step.
void write_provenance(hdf5::Writer& writer, const Provenance& provenance);
Provenance read_provenance(const hdf5::Reader& reader);
void check_provenance(const Checks& checks, const Provenance& provenance);

}  // namespace palpate
