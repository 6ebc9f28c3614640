// Storage of properties while there is no machine: the interface by which start-up uses a file format without
// knowing it.
#pragma once

#include "kernel/component/property_transaction.hpp"
#include "kernel/machine/table/components.hpp"

namespace tappet {

/// Provided by the owner of the format, kernel/services/configuration. Not real-time.
struct PropertyStore {
    void* self = nullptr;
    /// Proposes the values of the row's file; returns an empty sentence, or the fault with file, line and
    /// cure.
    Sentence (*load)(void* self, const ComponentRow& row, PropertyTransaction& into) = nullptr;
    /// Writes a transaction that holds every property to the row's file.
    Sentence (*save)(void* self, const ComponentRow& row, const PropertyTransaction& from) = nullptr;
};

} // namespace tappet
