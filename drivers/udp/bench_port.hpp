// The plant's end of a UDP port on the bench: it sends to the port where the machine listens.
#pragma once

#include "drivers/twin/bench_end.hpp"
#include "drivers/udp/sender.hpp"

namespace tappet::udp {

/// Does not receive the machine's datagrams: machines reach each other directly on a bench.
class BenchPort final : public BenchEnd {
public:
    static constexpr const DeviceKind& kind = device_kind;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override { return provide<Wires>(name, sender_); }

private:
    Sender sender_{};
};

} // namespace tappet::udp
