// The plant's end of a UDP port on the bench: it sends to where the machine listens.
#pragma once

#include "drivers/twin/bench_end.hpp"
#include "drivers/udp/sender.hpp"

namespace tappet::udp {

/// What the machine sends is not heard: machines reach each other themselves on a bench.
class BenchPort final : public BenchEnd {
public:
    static constexpr const DeviceKind& kind = device_kind;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override {
        return {type_id<Wires>, name, static_cast<Wires*>(&sender_)};
    }

private:
    Sender sender_{};
};

} // namespace tappet::udp
