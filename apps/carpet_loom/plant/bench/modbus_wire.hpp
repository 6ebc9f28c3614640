// The plant's Modbus TCP server on libmodbus, in a thread of its own: a slow master never delays the loom.
#pragma once

#include "apps/carpet_loom/plant/climate.hpp"

#include <modbus.h>

#include <atomic>
#include <expected>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace tappet::loom {

class ModbusWire {
public:
    [[nodiscard]] static std::expected<std::unique_ptr<ModbusWire>, std::string>
    open(const std::string& address, int port, Climate& climate);
    ModbusWire(const ModbusWire&) = delete;
    ModbusWire& operator=(const ModbusWire&) = delete;
    ~ModbusWire();

    /// Swaps registers with the unit; skipped when a request is just being answered.
    void exchange(Climate& climate);
    /// While it is off the server's sockets are closed: a master sees connections reset and refused.
    void set_power(bool on) { powered_.store(on); }

private:
    ModbusWire(modbus_t* context, modbus_mapping_t* mapping);
    void serve();
    void answer(int client);
    void close_all();

    struct FreeContext {
        void operator()(modbus_t* context) const { modbus_free(context); }
    };
    struct FreeMapping {
        void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
    };
    std::unique_ptr<modbus_t, FreeContext> context_;
    std::unique_ptr<modbus_mapping_t, FreeMapping> mapping_;
    std::mutex registers_; // guards mapping_
    bool primed_ =
        false; // the mapping holds the unit's own values, so a master's writes can be told from zeros
    int listening_ = -1;
    static constexpr std::size_t most_clients = 8;
    std::array<int, most_clients> clients_;
    std::atomic<bool> powered_{true};
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

} // namespace tappet::loom
