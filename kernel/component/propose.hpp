// A property's new value as text, as a person or a browser gives it.
#pragma once

#include "kernel/base/nearest.hpp"
#include "kernel/base/value_text.hpp"
#include "kernel/component/property_transaction.hpp"

namespace tappet {

/// Adds one value to the transaction, which was begun. Empty: it is proposed; else what is wrong and the
/// cure, and the transaction is worth nothing. Not real-time.
[[nodiscard]] inline Sentence propose(PropertyTransaction& into, std::string_view property,
                                      std::string_view text) noexcept {
    const auto facets = into.type().facets;
    Nearest nearest{property};
    for (std::size_t f = 0; f < facets.size(); ++f) {
        if (facets[f].kind != FacetKind::property) continue;
        nearest.consider(facets[f].name);
        if (facets[f].name != property) continue;
        std::byte* place = into.change(f);
        if (place == nullptr)
            return Sentence{"a transaction holds no more than ", PropertyTransaction::max_values,
                            " values; divide it"};
        if (const Sentence fault = parse_value(*facets[f].type, text, place); !fault.empty())
            return Sentence{"property \"", property, "\": ", fault};
        return PropertyTransaction::check_range(facets[f], place);
    }
    Sentence fault{"component \"", into.name(), "\" has no property \"", property, "\""};
    if (nearest.best().empty()) return fault.add("; ask for the list of its properties");
    return fault.add("; did you mean \"").add(nearest.best()).add("\"?");
}

} // namespace tappet
