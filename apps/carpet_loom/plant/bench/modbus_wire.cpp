// The server's thread: sockets, requests, and the answers libmodbus cannot know.
#include "apps/carpet_loom/plant/bench/modbus_wire.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::loom {
namespace {

constexpr int poll_ms = 20; // how fast power and the end are noticed

unsigned word_at(const std::uint8_t* bytes, int offset) {
    return (static_cast<unsigned>(bytes[offset]) << 8) | bytes[offset + 1];
}

/// A write of holding registers whose values the unit refuses. `body` begins at the function code.
bool has_illegal_value(const std::uint8_t* body, int length) {
    const auto refused = [](unsigned address, unsigned value) {
        const auto answer = Climate::check_holding_register(static_cast<std::uint16_t>(address),
                                                            static_cast<std::uint16_t>(value));
        return !answer && answer.error() == ModbusError::illegal_value;
    };
    if (body[0] == MODBUS_FC_WRITE_SINGLE_REGISTER && length >= 5)
        return refused(word_at(body, 1), word_at(body, 3));
    if (body[0] != MODBUS_FC_WRITE_MULTIPLE_REGISTERS || length < 6) return false;
    const unsigned first = word_at(body, 1);
    const unsigned count = word_at(body, 3);
    for (unsigned i = 0; i < count && 6 + 2 * static_cast<int>(i) + 1 < length; ++i)
        if (refused(first + i, word_at(body, 6 + 2 * static_cast<int>(i)))) return true;
    return false;
}

} // namespace

std::expected<std::unique_ptr<ModbusWire>, std::string> ModbusWire::open(const std::string& address, int port,
                                                                         Climate& climate) {
    modbus_t* const context = modbus_new_tcp(address.c_str(), port);
    if (context == nullptr)
        return std::unexpected("Modbus on " + address + ": " + modbus_strerror(errno) +
                               "; --modbus-address wants a numeric address");
    modbus_mapping_t* const mapping =
        modbus_mapping_new(wires::modbus::coil::count, wires::modbus::discrete_input::count,
                           wires::modbus::holding_register::count, wires::modbus::input_register::count);
    std::unique_ptr<ModbusWire> wire(new ModbusWire(context, mapping));
    wire->listening_ = modbus_tcp_listen(context, static_cast<int>(most_clients));
    if (mapping == nullptr || wire->listening_ < 0)
        return std::unexpected("Modbus on " + address + ":" + std::to_string(port) + ": " +
                               modbus_strerror(errno) + "; free the port or name another by --modbus-port");
    wire->exchange(climate); // no master may read zeros that are no set points
    wire->thread_ = std::thread([server = wire.get()] { server->serve(); });
    return wire;
}

ModbusWire::ModbusWire(modbus_t* context, modbus_mapping_t* mapping) : context_(context), mapping_(mapping) {
    clients_.fill(-1);
    modbus_set_slave(context, wires::modbus::unit);
    modbus_set_response_timeout(context, 0, 100'000);
    modbus_set_byte_timeout(context, 0, 100'000);
}

ModbusWire::~ModbusWire() {
    ending_.store(true);
    if (thread_.joinable()) thread_.join();
    close_all();
}

void ModbusWire::close_all() {
    if (listening_ >= 0) close(listening_);
    listening_ = -1;
    for (int& client : clients_) {
        if (client >= 0) close(client);
        client = -1;
    }
}

void ModbusWire::exchange(Climate& climate) {
    const std::unique_lock lock(registers_, std::try_to_lock);
    if (!lock) return;
    modbus_mapping_t& map = *mapping_;
    for (std::uint16_t i = 0; i < wires::modbus::input_register::count; ++i)
        map.tab_input_registers[i] = climate.input_register(i).value_or(0);
    map.tab_input_bits[0] = climate.discrete_input(0).value_or(false) ? 1 : 0;
    for (std::uint16_t i = 0; i < wires::modbus::holding_register::count; ++i) {
        if (primed_) static_cast<void>(climate.write_holding_register(i, map.tab_registers[i]));
        map.tab_registers[i] = climate.holding_register(i).value_or(0);
    }
    if (primed_)
        static_cast<void>(climate.write_coil(wires::modbus::coil::lubrication_pump, map.tab_bits[0] != 0));
    primed_ = true;
}

void ModbusWire::answer(int client) {
    std::uint8_t query[MODBUS_TCP_MAX_ADU_LENGTH];
    modbus_set_socket(context_.get(), client);
    const int length = modbus_receive(context_.get(), query);
    if (length < 0) {
        for (int& known : clients_)
            if (known == client) known = -1;
        close(client);
        return;
    }
    const int header = modbus_get_header_length(context_.get());
    if (length <= header) return;
    const int unit = query[header - 1];
    if (unit != wires::modbus::unit && unit != MODBUS_TCP_SLAVE)
        return; // another unit behind the same address
    const std::lock_guard lock(registers_);
    if (has_illegal_value(query + header, length - header))
        modbus_reply_exception(context_.get(), query, MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
    else
        modbus_reply(context_.get(), query, length, mapping_.get());
}

void ModbusWire::serve() {
    while (!ending_.load()) {
        if (!powered_.load()) {
            close_all();
            std::this_thread::sleep_for(std::chrono::milliseconds{poll_ms});
            continue;
        }
        if (listening_ < 0) listening_ = modbus_tcp_listen(context_.get(), static_cast<int>(most_clients));
        std::array<pollfd, 1 + most_clients> watched;
        watched[0] = {listening_, POLLIN, 0};
        for (std::size_t i = 0; i < most_clients; ++i) watched[1 + i] = {clients_[i], POLLIN, 0};
        if (poll(watched.data(), watched.size(), poll_ms) <= 0) continue;
        if (watched[0].revents != 0) {
            const int client = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
            const auto free = std::find(clients_.begin(), clients_.end(), -1);
            if (client >= 0 && free != clients_.end())
                *free = client;
            else if (client >= 0)
                close(client);
        }
        for (std::size_t i = 1; i < watched.size(); ++i)
            if (watched[i].fd >= 0 && watched[i].revents != 0) answer(watched[i].fd);
    }
}

} // namespace tappet::loom
