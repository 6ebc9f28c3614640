// hello, then map: every browser's first requests.
#include "toolchain/tools/browser/session.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::browser {

Result<std::unique_ptr<Session>> Session::open(const std::string& socket, std::chrono::milliseconds patience,
                                               std::string place, const User* user) {
    auto link = Link::connect(socket);
    if (!link) return std::unexpected(link.error());
    link->patience = patience;
    if (user != nullptr)
        if (const auto named = link->request("as " + user->name + " " + user->role + " " + user->origin);
            !named)
            return std::unexpected(named.error());
    const auto hello = link->request("hello");
    if (!hello) return std::unexpected(hello.error());
    const auto spoken = hello->value("protocol", std::uint32_t{0});
    if (spoken != browsing::protocol_version)
        return failure(Fault::no_machine, "the machine speaks protocol " + std::to_string(spoken) +
                                              ", this browser protocol " +
                                              std::to_string(browsing::protocol_version) +
                                              "; use the browser that was built with the firmware");
    if (const auto given = link->request("map"); !given) return std::unexpected(given.error());
    const int descriptor = link->take_descriptor();
    if (descriptor < 0)
        return failure(Fault::no_machine,
                       "the machine handed no memory over; is it built with a browser service?");
    auto block = SharedBlock::map(descriptor);
    ::close(descriptor);
    if (!block) return std::unexpected(block.error());
    auto map = MapReader::open(block->bytes(), std::move(place));
    if (!map) return failure(Fault::no_machine, map.error());
    return std::unique_ptr<Session>{new Session{std::move(*link), std::move(*block), std::move(*map),
                                                hello->value("role", std::string{"unknown"})}};
}

Result<std::unique_ptr<Session>> Session::open_black_box(const std::string& file) {
    const auto wrong = [&](const std::string& why) {
        return failure(Fault::bad_request, "'" + file + "' " + why);
    };
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return wrong(std::string{"cannot be opened: "} + std::strerror(errno));
    auto record = std::make_unique<map::black_box::Record>();
    const bool is_one = ::read(descriptor, record.get(), sizeof *record) == sizeof *record &&
                        record->magic == map::black_box::magic;
    auto block = is_one ? SharedBlock::map(descriptor, map::black_box::memory_at)
                        : Result<SharedBlock>{std::unexpected(Failure{})};
    ::close(descriptor);
    if (!is_one) return wrong("is not a black box; a guardian prints the file's name when it writes one");
    if (record->version != map::black_box::version)
        return wrong("is a black box of version " + std::to_string(record->version) +
                     "; use the browser that was built with the firmware");
    for (const auto text :
         {std::span{record->machine}, std::span{record->board}, std::span{record->build_id}})
        text.back() = 0;
    record->reason.back() = record->done.back() = record->thread_name.back() = 0;
    if (record->memory_bytes == 0)
        return wrong("holds no memory of the machine, which had no BrowserService; what is known: " +
                     std::string{record->reason.data()} + "; " + record->done.data());
    if (!block || block->bytes().size() < record->memory_bytes)
        return wrong("is cut off: its machine had " + std::to_string(record->memory_bytes) + " bytes");
    const auto memory = block->bytes().first(record->memory_bytes);
    const auto after = block->bytes().subspan(record->memory_bytes);
    auto map = MapReader::open(memory);
    if (!map) return wrong("holds a machine that cannot be read: " + map.error());
    auto link = Link::to_nobody(file, {reinterpret_cast<const char*>(after.data()), after.size()});
    return std::unique_ptr<Session>{
        new Session{std::move(link), std::move(*block), std::move(*map), "reader", std::move(record)}};
}

} // namespace tappet::browser
