// The plant's Modbus TCP server on libmodbus, in a thread of its own: a slow client never delays the plant.
#pragma once

#include "drivers/modbus/far_end.hpp"
#include "kernel/base/text.hpp"

#include <modbus.h>

#include <array>
#include <atomic>
#include <expected>
#include <memory>
#include <string>
#include <thread>

namespace tappet {

/// Not real-time.
class ServerEnd final : public modbus::ServerTables {
public:
    ServerEnd();
    ~ServerEnd();

    /// Answers from now on, for the addresses that it was said to have. The error says what is wrong and how
    /// to cure it.
    std::expected<void, Sentence> listen(const std::string& address, int port, int unit);
    /// While it is off its sockets are closed: a client sees connections reset and refused.
    void set_power(bool on) { powered_.store(on); }

private:
    void serve();
    void answer(int client);
    void close_all();
    void to_mapping();
    void from_mapping(const std::uint8_t* request, int length);
    [[nodiscard]] bool refuses(const std::uint8_t* request, int length) const;

    struct FreeContext {
        void operator()(modbus_t* context) const { modbus_free(context); }
    };
    struct FreeMapping {
        void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
    };
    std::unique_ptr<modbus_t, FreeContext> context_{};
    std::unique_ptr<modbus_mapping_t, FreeMapping> mapping_{};
    int unit_ = 1;
    int listening_ = -1;
    static constexpr std::size_t most_clients = 8;
    std::array<int, most_clients> clients_{};
    std::atomic<bool> powered_{true};
    std::atomic<bool> ending_{false};
    std::thread thread_{};
};

} // namespace tappet
