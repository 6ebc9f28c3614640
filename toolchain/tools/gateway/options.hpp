// The options of tappet-gateway.
#pragma once

#include "toolchain/command_line.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tappet::network {

inline constexpr std::array gateway_options{
    Option{"--directory", "DIR", "where machines have their sockets (/run/tappet)"},
    Option{"--listen", "ADDRESS:PORT",
           "where clients come in (0.0.0.0:8443; with --loopback 127.0.0.1:8080); port 0: any"},
    Option{"--loopback", "", "no TLS and no users: everyone at this host is its user, as engineer"},
    Option{"--users", "FILE", "the users file, which `tappet-gateway user` writes"},
    Option{"--certificate", "FILE",
           "the certificate, as PEM (default: one that the gateway makes in its state folder)"},
    Option{"--key", "FILE", "its key, as PEM"},
    Option{"--state", "DIR", "the folder of the gateway's own certificate (/var/lib/tappet-gateway)"},
    Option{"--black-boxes", "DIR",
           "where guardians keep black boxes, which users may then read (default: none is shown)"},
    Option{"--log", "FILE", "the log of changes: who asked what, and whether it was done"},
    Option{"--processors", "LIST", "where the gateway may run, for example 0,2-3 (default: anywhere)"},
    Option{"--help", "", "this text"}};

struct Options {
    std::string directory{};
    std::string address{};
    std::uint16_t port = 0;
    bool loopback = false;
    std::string users{};
    std::string certificate{};
    std::string key{};
    std::string state{};
    std::string log{};
    std::string black_boxes{};
    std::vector<unsigned> processors{};
};

/// Returns the options with their defaults; the error names the fault, and the cure.
[[nodiscard]] std::expected<Options, std::string> read_options(const CommandLine& line);

} // namespace tappet::network
