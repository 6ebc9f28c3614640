// Where properties are kept while there is no machine: what start-up asks of a file format without knowing
// it.
#pragma once

#include "kernel/component/property_transaction.hpp"
#include "kernel/machine/table/components.hpp"

namespace tappet {

/// Filled by whoever knows the format; kernel/services/configuration does. Not real-time.
struct PropertyStore {
    void* self = nullptr;
    /// Proposes what the row's file says; an empty sentence, or the fault with file, line and cure.
    Sentence (*load)(void* self, const ComponentRow& row, PropertyTransaction& into) = nullptr;
    /// Writes a transaction that holds every property to the row's file.
    Sentence (*save)(void* self, const ComponentRow& row, const PropertyTransaction& from) = nullptr;
};

} // namespace tappet
