// The plant's Modbus TCP server on libmodbus, in a thread of its own: a slow client never delays the plant.
#pragma once

#include "drivers/modbus/far_end.hpp"
#include "drivers/modbus/kind.hpp"
#include "drivers/twin/bench_end.hpp"

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>

struct _modbus;
struct _modbus_mapping_t;

namespace tappet::modbus {

/// Not real-time.
class BenchServer final : public BenchEnd, public ServerTables {
public:
    static constexpr const DeviceKind& kind = device_kind;

    BenchServer();
    ~BenchServer() override;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override {
        return provide<ServerTables>(name, *this);
    }
    /// Starts to answer, for the addresses stated by have().
    std::expected<void, Sentence> listen() override;
    /// Switches the server. While it is off its sockets are closed: connections are reset and refused.
    void set_power(bool on) override { powered_.store(on); }

private:
    void serve();
    void answer(int client);
    void close_all();
    void to_mapping();
    void from_mapping(const std::uint8_t* request, int length);
    [[nodiscard]] bool refuses(const std::uint8_t* request, int length) const;

    struct FreeContext {
        void operator()(_modbus* context) const;
    };
    struct FreeMapping {
        void operator()(_modbus_mapping_t* mapping) const;
    };
    std::unique_ptr<_modbus, FreeContext> context_{};
    std::unique_ptr<_modbus_mapping_t, FreeMapping> mapping_{};
    std::string address_{};
    int port_ = 0, unit_ = 1;
    int listening_ = -1;
    static constexpr std::size_t most_clients = 8;
    std::array<int, most_clients> clients_{};
    std::atomic<bool> powered_{true};
    std::atomic<bool> ending_{false};
    std::thread thread_{};
};

} // namespace tappet::modbus
