// A change of several properties of one component as one (thesis 4.7.1): checked where they are proposed,
// then offered between two steps to the component, which accepts all of them or none.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/exchange/mailbox.hpp"

#include <array>
#include <atomic>
#include <cstring>

namespace tappet {

/// One thread fills it, posts message() to the component's engine, and then leaves the object alone until
/// finished(). It also holds a copy of the present values, taken in the engine or from a component that is
/// stopped.
class PropertyTransaction {
public:
    static constexpr std::size_t max_values = 64;
    static constexpr std::size_t max_bytes = 2048;
    static constexpr std::size_t alignment = 16;

    enum class State : std::uint8_t { open, posted, done, refused };

    static constexpr std::size_t bytes_for(const Facet& facet) noexcept {
        return (facet.type->size + alignment - 1) / alignment * alignment;
    }

    /// Empties it for proposals to this component. `name` must outlive it.
    void begin(std::string_view name, const ComponentType& type, void* component) noexcept {
        name_ = name, type_ = &type, component_ = component;
        count_ = used_ = 0;
        refusal_ = Sentence{};
        state_.store(State::open, std::memory_order_relaxed);
    }

    /// Returns room for a new value of that property: zeros, or the earlier proposal. Null: not a property,
    /// or no room, which the table's check rules out for one component's own properties.
    [[nodiscard]] std::byte* change(std::size_t facet_index) noexcept {
        const Facet& facet = type_->facets[facet_index];
        if (facet.kind != FacetKind::property) return nullptr;
        for (std::size_t i = 0; i < count_; ++i)
            if (values_[i].facet == facet_index) return place_of(values_[i]);
        const std::size_t needed = bytes_for(facet);
        if (count_ == max_values || used_ + needed > max_bytes) return nullptr;
        std::byte* place = bytes_.data() + used_;
        std::memset(place, 0, needed);
        values_[count_++] = {static_cast<std::byte*>(facet.at(component_, facet.index)), place,
                             static_cast<std::uint32_t>(facet.type->size),
                             static_cast<std::uint32_t>(facet_index)};
        used_ += needed;
        return place;
    }
    /// Withdraws the last change().
    void withdraw_last() noexcept {
        --count_;
        used_ -= bytes_for(type_->facets[values_[count_].facet]);
    }
    [[nodiscard]] bool changes(std::size_t facet_index) const noexcept {
        for (const ProposedValue& each : values())
            if (each.facet == facet_index) return true;
        return false;
    }
    /// Makes room for all properties, for capture().
    void change_all() noexcept {
        for (std::size_t f = 0; f < type_->facets.size(); ++f) static_cast<void>(change(f));
    }

    /// Asks the component and, when it consents, sets all values. Only where the component runs, or while it
    /// is stopped. Real-time.
    void commit() noexcept TAPPET_REALTIME {
        refusal_ = type_->change(component_, values());
        state_.store(refusal_.empty() ? State::done : State::refused, std::memory_order_release);
    }
    /// Copies the present values of the properties that it has room for, and asks the component whether it
    /// would consent to them: refusal(). Where the component runs, or while it is stopped. Real-time.
    void capture() noexcept TAPPET_REALTIME {
        for (const ProposedValue& each : values()) std::memcpy(place_of(each), each.target, each.size);
        if (type_->accepts != nullptr) refusal_ = type_->accepts(component_, Proposal{values()});
        state_.store(State::done, std::memory_order_release);
    }

    /// Return the calls to post to the component's engine; `part` is the component's number there.
    [[nodiscard]] Message commit_message(std::uint32_t part) noexcept {
        return message(part, [](void* self, const std::byte*) noexcept
                       TAPPET_REALTIME { static_cast<PropertyTransaction*>(self)->commit(); });
    }
    [[nodiscard]] Message capture_message(std::uint32_t part) noexcept {
        return message(part, [](void* self, const std::byte*) noexcept
                       TAPPET_REALTIME { static_cast<PropertyTransaction*>(self)->capture(); });
    }
    [[nodiscard]] State state() const noexcept TAPPET_REALTIME {
        return state_.load(std::memory_order_acquire);
    }
    [[nodiscard]] bool finished() const noexcept TAPPET_REALTIME {
        return state() == State::done || state() == State::refused;
    }
    /// Returns the fault of its values, by their ranges or by the component that was asked: a proposal of
    /// them would be refused. Empty: none.
    [[nodiscard]] Sentence check() const noexcept {
        for (const ProposedValue& each : values())
            if (Sentence fault = check_range(type_->facets[each.facet], each.value); !fault.empty())
                return fault;
        return refusal_;
    }
    /// Returns why the component did not consent; once refused.
    [[nodiscard]] const Sentence& refusal() const noexcept { return refusal_; }

    [[nodiscard]] std::span<const ProposedValue> values() const noexcept TAPPET_REALTIME {
        return {values_.data(), count_};
    }
    [[nodiscard]] const ComponentType& type() const noexcept { return *type_; }
    [[nodiscard]] void* component() const noexcept { return component_; }
    [[nodiscard]] std::string_view name() const noexcept { return name_; }

private:
    [[nodiscard]] std::byte* place_of(const ProposedValue& value) noexcept TAPPET_REALTIME {
        return bytes_.data() + (value.value - bytes_.data());
    }
    [[nodiscard]] Message message(std::uint32_t part, Message::Run run) noexcept {
        Message made;
        made.run = run;
        made.object = this;
        made.id = part;
        state_.store(State::posted, std::memory_order_relaxed);
        return made;
    }
    std::string_view name_{};
    const ComponentType* type_ = nullptr;
    void* component_ = nullptr;
    std::size_t count_ = 0;
    std::size_t used_ = 0;
    std::array<ProposedValue, max_values> values_{};
    alignas(alignment) std::array<std::byte, max_bytes> bytes_{};
    Sentence refusal_{};
    std::atomic<State> state_{State::open};
};

} // namespace tappet
