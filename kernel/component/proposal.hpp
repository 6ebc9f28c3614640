// The question to a component before its properties change (thesis 4.7): the values as they would be.
#pragma once

#include "kernel/component/property.hpp"

#include <cstring>
#include <span>

namespace tappet {

/// One proposed value: its destination and its bytes.
struct ProposedValue {
    std::byte* target = nullptr;
    const std::byte* value = nullptr;
    std::uint32_t size = 0;
    std::uint32_t facet = 0; ///< number of the facet in the component's type
};

/// The argument of `Sentence accepts(const Proposal&) const noexcept TAPPET_REALTIME`: an empty sentence is
/// consent; any other is the answer to the request. Real-time.
class Proposal {
public:
    explicit Proposal(std::span<const ProposedValue> values) noexcept TAPPET_REALTIME : values_{values} {}

    /// Returns the value that this property would have: the proposed one, or the present one.
    template <class T>
    [[nodiscard]] T of(const Property<T>& property) const noexcept TAPPET_REALTIME {
        T value = property.get();
        if (const ProposedValue* proposed = find(&property))
            std::memcpy(static_cast<void*>(&value), proposed->value, sizeof(T));
        return value;
    }
    template <class T>
    [[nodiscard]] bool changes(const Property<T>& property) const noexcept TAPPET_REALTIME {
        return find(&property) != nullptr;
    }

private:
    [[nodiscard]] const ProposedValue* find(const void* target) const noexcept TAPPET_REALTIME {
        for (const ProposedValue& each : values_)
            if (each.target == target) return &each;
        return nullptr;
    }
    std::span<const ProposedValue> values_;
};

} // namespace tappet
