// The server's thread: sockets, requests, and the answers that libmodbus cannot give.
#include "drivers/modbus/bench_server.hpp"

#include "kernel/base/address.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>

#include <modbus.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::modbus {

namespace {

constexpr int poll_ms = 20; // longest delay until set_power() or the destructor takes effect

unsigned word_at(const std::uint8_t* bytes, int offset) {
    return (static_cast<unsigned>(bytes[offset]) << 8) | bytes[offset + 1];
}

/// The values that a request writes; `count` 0: none. `body` begins at the function code.
struct Writes {
    Table table = Table::holding_registers;
    unsigned first = 0;
    unsigned count = 0;
};

Writes writes_of(const std::uint8_t* body, int length) {
    if (length < 5) return {};
    switch (body[0]) {
    case MODBUS_FC_WRITE_SINGLE_COIL: return {Table::coils, word_at(body, 1), 1};
    case MODBUS_FC_WRITE_SINGLE_REGISTER: return {Table::holding_registers, word_at(body, 1), 1};
    case MODBUS_FC_WRITE_MULTIPLE_COILS: return {Table::coils, word_at(body, 1), word_at(body, 3)};
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
        return {Table::holding_registers, word_at(body, 1), word_at(body, 3)};
    default: return {};
    }
}

} // namespace

void BenchServer::FreeContext::operator()(_modbus* context) const { modbus_free(context); }
void BenchServer::FreeMapping::operator()(_modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }

BenchServer::BenchServer() { clients_.fill(-1); }

BenchServer::~BenchServer() {
    ending_.store(true);
    if (thread_.joinable()) thread_.join();
    close_all();
}

std::expected<void, Sentence> BenchServer::open(const DevicePlace& place) {
    if (place.is_on_board)
        return std::unexpected(
            Sentence{"this server serves Modbus TCP only; bind the device to 127.0.0.1:1502"});
    address_ = host_of(place.address);
    port_ = port_of(place.address);
    unit_ = server_facts(place.bound).unit;
    return {};
}

std::expected<void, Sentence> BenchServer::listen() {
    context_.reset(modbus_new_tcp(address_.c_str(), port_));
    const auto entries = [this](Table table) { return static_cast<int>(count(table)); };
    mapping_.reset(modbus_mapping_new(entries(Table::coils), entries(Table::discrete_inputs),
                                      entries(Table::holding_registers), entries(Table::input_registers)));
    if (context_ != nullptr && mapping_ != nullptr)
        listening_ = modbus_tcp_listen(context_.get(), static_cast<int>(most_clients));
    if (listening_ < 0)
        return std::unexpected(Sentence{"Modbus server at \"", std::string_view{address_}, ":", port_,
                                        "\": ", std::string_view{modbus_strerror(errno)},
                                        "; free the port, or bind the machine to another"});
    modbus_set_slave(context_.get(), unit_);
    modbus_set_response_timeout(context_.get(), 0, 100'000);
    modbus_set_byte_timeout(context_.get(), 0, 100'000);
    thread_ = std::thread([this] { serve(); });
    return {};
}

void BenchServer::close_all() {
    if (listening_ >= 0) ::close(listening_);
    listening_ = -1;
    for (int& client : clients_) {
        if (client >= 0) ::close(client);
        client = -1;
    }
}

void BenchServer::to_mapping() {
    const auto copy = [this](Table table, auto* into) {
        for (std::size_t i = 0; i < count(table); ++i)
            into[i] = static_cast<std::remove_reference_t<decltype(*into)>>(get(table, i));
    };
    copy(Table::coils, mapping_->tab_bits);
    copy(Table::discrete_inputs, mapping_->tab_input_bits);
    copy(Table::holding_registers, mapping_->tab_registers);
    copy(Table::input_registers, mapping_->tab_input_registers);
}

void BenchServer::from_mapping(const std::uint8_t* request, int length) {
    const Writes written = writes_of(request, length);
    for (unsigned i = written.first; i < written.first + written.count && i < count(written.table); ++i)
        set(written.table, i,
            written.table == Table::coils ? mapping_->tab_bits[i] : mapping_->tab_registers[i]);
}

bool BenchServer::refuses(const std::uint8_t* body, int length) const {
    const Writes written = writes_of(body, length);
    if (written.count == 0 || written.table == Table::coils) return false;
    const bool single = body[0] == MODBUS_FC_WRITE_SINGLE_REGISTER;
    for (unsigned i = 0; i < written.count; ++i) {
        const int at = single ? 3 : 6 + 2 * static_cast<int>(i);
        if (at + 1 >= length) return false;
        if (!accepts(written.table, written.first + i, static_cast<std::uint16_t>(word_at(body, at))))
            return true;
    }
    return false;
}

void BenchServer::answer(int client) {
    std::uint8_t query[MODBUS_TCP_MAX_ADU_LENGTH];
    modbus_set_socket(context_.get(), client);
    const int length = modbus_receive(context_.get(), query);
    if (length < 0) {
        for (int& known : clients_)
            if (known == client) known = -1;
        ::close(client);
        return;
    }
    const int header = modbus_get_header_length(context_.get());
    if (length <= header) return;
    const int unit = query[header - 1];
    if (unit != unit_ && unit != MODBUS_TCP_SLAVE) return; // meant for another unit behind the same address
    const auto all = whole();
    to_mapping();
    // libmodbus would answer these two functions, but change only its own copy of the registers.
    if (const int function = query[header];
        function == MODBUS_FC_MASK_WRITE_REGISTER || function == MODBUS_FC_WRITE_AND_READ_REGISTERS) {
        modbus_reply_exception(context_.get(), query, MODBUS_EXCEPTION_ILLEGAL_FUNCTION);
        return;
    }
    if (refuses(query + header, length - header)) {
        modbus_reply_exception(context_.get(), query, MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
        return;
    }
    modbus_reply(context_.get(), query, length, mapping_.get());
    from_mapping(query + header, length - header);
}

void BenchServer::serve() {
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
        if (::poll(watched.data(), watched.size(), poll_ms) <= 0) continue;
        if ((watched[0].revents & POLLIN) != 0) {
            const int client = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
            const auto free = std::ranges::find(clients_, -1);
            if (client >= 0 && free != clients_.end())
                *free = client;
            else if (client >= 0)
                ::close(client);
        }
        for (std::size_t i = 0; i < most_clients; ++i)
            if (watched[1 + i].fd >= 0 && watched[1 + i].revents != 0) answer(watched[1 + i].fd);
    }
}

} // namespace tappet::modbus
