// The object dictionary of a simulated device at run time: values are read and written over SDO as the
// device's file allows, with injected refusals.
#pragma once

#include "drivers/canopen/protocol.hpp"
#include "drivers/canopen/sdo_server.hpp"
#include "kernel/base/bounded.hpp"

namespace tappet::canopen {

/// `values` has one entry for each object of the dictionary, and is first used by reset(); dictionary and
/// values must outlive this. Real-time.
class SimulatedObjects : public ObjectAccess {
public:
    SimulatedObjects(std::uint8_t node, const Dictionary& dictionary,
                     std::span<std::uint64_t> values) noexcept TAPPET_REALTIME : node_{node},
                                                                                 dictionary_{&dictionary},
                                                                                 values_{values} {}

    [[nodiscard]] const Dictionary& dictionary() const noexcept TAPPET_REALTIME { return *dictionary_; }
    /// Sets the objects from one index to another to the values of the file.
    void reset(std::uint16_t first, std::uint16_t last) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const Object& object = dictionary_->objects[i];
            if (object.at.index >= first && object.at.index <= last) values_[i] = object.value.of(node_);
        }
        for (const Address& at :
             {Address{0x1000}, Address{0x1018, 1}, Address{0x1018, 2}, Address{0x1018, 3}})
            if (is_replaced_) set(at, identity_part(at));
        texts_.clear();
    }
    /// Fault: it identifies as another device than in its file.
    void replace(const Identity& by) noexcept TAPPET_REALTIME {
        is_replaced_ = true;
        identity_ = by;
        reset(0x1000, 0x1018);
    }
    /// Fault: reads and writes of that object are answered with this code; `none` ends it.
    void refuse(Address at, SdoAbort why) noexcept TAPPET_REALTIME { refused_ = {at, why}; }
    /// Fault: writes to that object are confirmed but lost; an address without an object ends it.
    void lose_writes(Address at) noexcept TAPPET_REALTIME { lost_ = at; }

    [[nodiscard]] bool has(Address at) const noexcept TAPPET_REALTIME {
        return dictionary_->find(at) != nullptr;
    }
    /// Returns the value; 0 where there is no object.
    [[nodiscard]] std::uint64_t get(Address at) const noexcept TAPPET_REALTIME {
        const Object* const object = dictionary_->find(at);
        return object == nullptr ? 0 : values_[index_of(*object)];
    }
    [[nodiscard]] std::int64_t get_signed(Address at) const noexcept TAPPET_REALTIME {
        const Object* const object = dictionary_->find(at);
        if (object == nullptr) return 0;
        const std::uint64_t value = values_[index_of(*object)];
        const unsigned wide = bits_of(object->type);
        if (wide == 0 || wide >= 64 || (value >> (wide - 1) & 1) == 0)
            return static_cast<std::int64_t>(value);
        return static_cast<std::int64_t>(value | ~low_bits(~std::uint64_t{0}, wide));
    }
    /// Sets a value from the device's side, regardless of access; bits beyond the object's are cut.
    void set(Address at, std::uint64_t value) noexcept TAPPET_REALTIME {
        if (const Object* const object = dictionary_->find(at))
            values_[index_of(*object)] = low_bits(value, bits_of(object->type));
    }

    [[nodiscard]] SdoAbort read_object(Address at, std::span<std::uint8_t> into, std::size_t& size) noexcept
        TAPPET_REALTIME override {
        if (refused_.at == at && refused_.why != SdoAbort::none) return refused_.why;
        const Object* const object = dictionary_->find(at);
        if (object == nullptr) return missing(at);
        if (!readable(object->access)) return SdoAbort::write_only;
        if (const unsigned bytes = bytes_of(object->type); bytes != 0) {
            size = bytes;
            to_bytes(values_[index_of(*object)], into.first(size));
            return SdoAbort::none;
        }
        for (const StoredText& text : texts_)
            if (text.object == index_of(*object)) return give(text.view(), into, size);
        return give(object->text, into, size);
    }
    [[nodiscard]] SdoAbort write_object(Address at, std::span<const std::uint8_t> value) noexcept
        TAPPET_REALTIME override {
        if (refused_.at == at && refused_.why != SdoAbort::none) return refused_.why;
        const Object* const object = dictionary_->find(at);
        if (object == nullptr) return missing(at);
        if (!writable(object->access)) return SdoAbort::read_only;
        if (bits_of(object->type) == 0) return keep_text(*object, value);
        if (value.size() > bytes_of(object->type)) return SdoAbort::too_long;
        if (value.size() < bytes_of(object->type)) return SdoAbort::too_short;
        const std::uint64_t bits = from_bytes(value);
        if (!within_limits(*object, bits, node_)) {
            Object upwards = *object;
            upwards.high = {};
            return within_limits(upwards, bits, node_) ? SdoAbort::too_high : SdoAbort::too_low;
        }
        if (const SdoAbort why = may_write(*object, bits); why != SdoAbort::none) return why;
        if (lost_ == at) return SdoAbort::none;
        values_[index_of(*object)] = bits;
        written(at);
        return SdoAbort::none;
    }

protected:
    /// Lets a device of this kind refuse a value that the file allows.
    virtual SdoAbort may_write(const Object&, std::uint64_t) noexcept TAPPET_REALTIME {
        return SdoAbort::none;
    }
    virtual void written(Address) noexcept TAPPET_REALTIME {}

    [[nodiscard]] std::size_t index_of(const Object& object) const noexcept TAPPET_REALTIME {
        return static_cast<std::size_t>(&object - dictionary_->objects.data());
    }
    [[nodiscard]] std::uint64_t& value_at(std::size_t index) noexcept TAPPET_REALTIME {
        return values_[index];
    }
    [[nodiscard]] std::uint8_t id() const noexcept TAPPET_REALTIME { return node_; }

private:
    struct StoredText {
        std::size_t object = 0;
        std::size_t size = 0;
        std::array<char, sdo::most_bytes> bytes{};
        [[nodiscard]] std::string_view view() const noexcept TAPPET_REALTIME { return {bytes.data(), size}; }
        bool operator==(const StoredText&) const = default;
    };
    struct Refused {
        Address at{};
        SdoAbort why = SdoAbort::none;
    };

    [[nodiscard]] SdoAbort missing(Address at) const noexcept TAPPET_REALTIME {
        for (const Object& object : dictionary_->objects)
            if (object.at.index == at.index) return SdoAbort::no_sub_index;
        return SdoAbort::no_object;
    }
    [[nodiscard]] std::uint64_t identity_part(Address at) const noexcept TAPPET_REALTIME {
        if (at.index == 0x1000) return identity_.device_type;
        return at.sub == 1 ? identity_.vendor : at.sub == 2 ? identity_.product : identity_.revision;
    }
    static SdoAbort give(std::string_view text, std::span<std::uint8_t> into, std::size_t& size) noexcept
        TAPPET_REALTIME {
        size = text.size() < into.size() ? text.size() : into.size();
        for (std::size_t i = 0; i < size; ++i) into[i] = static_cast<std::uint8_t>(text[i]);
        return SdoAbort::none;
    }
    SdoAbort keep_text(const Object& object, std::span<const std::uint8_t> value) noexcept TAPPET_REALTIME {
        StoredText text;
        text.object = index_of(object);
        text.size = value.size() < text.bytes.size() ? value.size() : text.bytes.size();
        for (std::size_t i = 0; i < text.size; ++i) text.bytes[i] = static_cast<char>(value[i]);
        for (StoredText& each : texts_)
            if (each.object == text.object) {
                each = text;
                return SdoAbort::none;
            }
        return texts_.push(text) ? SdoAbort::none : SdoAbort::out_of_memory;
    }

    std::uint8_t node_;
    const Dictionary* dictionary_;
    std::span<std::uint64_t> values_;
    Bounded<StoredText, 4> texts_{}; ///< those that were written
    bool is_replaced_ = false;
    Identity identity_{};
    Refused refused_{};
    Address lost_{};
};

} // namespace tappet::canopen
