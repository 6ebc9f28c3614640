// Reads the options and refuses combinations that make no sense.
#include "toolchain/tools/gateway/options.hpp"

#include "toolchain/tools/gateway/sandbox.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <charconv>

namespace tappet::network {

std::expected<Options, std::string> read_options(const CommandLine& line) {
    Options options;
    options.loopback = line.has("--loopback");
    options.directory = line.text("--directory", browsing::default_directory);
    options.users = line.text("--users");
    options.certificate = line.text("--certificate");
    options.key = line.text("--key");
    options.state = line.text("--state", "/var/lib/tappet-gateway");
    options.log = line.text("--log");
    options.black_boxes = line.text("--black-boxes");
    const std::string_view listen =
        line.text("--listen", options.loopback ? "127.0.0.1:8080" : "0.0.0.0:8443");
    const std::size_t colon = listen.rfind(':');
    const std::string_view port =
        colon == std::string_view::npos ? std::string_view{} : listen.substr(colon + 1);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), options.port);
    if (port.empty() || error != std::errc{} || end != port.data() + port.size())
        return std::unexpected("--listen: \"" + std::string{listen} +
                               "\" is not ADDRESS:PORT; write for example 0.0.0.0:8443 or [::1]:8443");
    options.address = listen.substr(0, colon);
    if (options.address.starts_with('[') && options.address.ends_with(']'))
        options.address = options.address.substr(1, options.address.size() - 2);
    if (options.loopback && options.address != "127.0.0.1" && options.address != "::1")
        return std::unexpected("--loopback serves without TLS and without users, so it listens at 127.0.0.1 "
                               "or ::1 only; leave it out, and give --users");
    if (options.loopback && (!options.users.empty() || !options.certificate.empty()))
        return std::unexpected(
            "--loopback has neither users nor a certificate; leave it out, or leave them out");
    if (!options.loopback && options.users.empty())
        return std::unexpected("nobody could log in without --users; write a file with `tappet-gateway user "
                               "add NAME ROLE --users FILE`, or use --loopback");
    if (options.certificate.empty() != options.key.empty())
        return std::unexpected("--certificate and --key belong together; give both, or none");
    if (!line.text("--processors").empty()) {
        auto processors = processors_from(line.text("--processors"));
        if (!processors) return std::unexpected(processors.error());
        options.processors = std::move(*processors);
    }
    return options;
}

} // namespace tappet::network
