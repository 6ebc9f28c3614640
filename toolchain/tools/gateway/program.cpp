// Puts the parts of the gateway together, confines the process, and serves.
#include "toolchain/tools/gateway/program.hpp"

#include "toolchain/tools/gateway/certificate.hpp"
#include "toolchain/tools/gateway/hub.hpp"
#include "toolchain/tools/gateway/sandbox.hpp"
#include "toolchain/tools/gateway/server.hpp"
#include "toolchain/tools/gateway/socket_relay.hpp"
#include "toolchain/tools/gateway/workers.hpp"

#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <ostream>

#include <malloc.h>
#include <unistd.h>

namespace tappet::network {

namespace {

namespace net = boost::asio;
using boost::system::error_code;

/// Returns the name of this process's user, which /etc/passwd holds in its first and third column.
std::string own_name() {
    std::ifstream lines{"/etc/passwd"};
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(':');
        const std::size_t second = line.find(':', first + 1);
        const std::size_t third = line.find(':', second + 1);
        if (first == std::string::npos || second == std::string::npos || third == std::string::npos) continue;
        const std::string name = line.substr(0, first);
        if (line.substr(second + 1, third - second - 1) == std::to_string(::getuid()) &&
            fault_in_name(name).empty())
            return name;
    }
    return "local";
}

std::expected<Access, std::string> access_of(const Options& options) {
    if (options.loopback) return Access{LoggedIn{own_name(), Role::engineer}};
    auto users = Users::read(options.users);
    if (!users) return std::unexpected(users.error());
    if (users->all().empty())
        return std::unexpected("'" + options.users + "' has no users; add one with tappet-gateway user add");
    return Access{options.users, std::move(*users)};
}

std::string folder_of(const std::string& file) {
    return std::filesystem::absolute(file).parent_path().string();
}

/// Calls a function again and again until the io_context ends.
class Every {
public:
    Every(net::io_context& io, std::chrono::milliseconds period, std::function<void(Clock::time_point)> what)
        : timer_{io}, period_{period}, what_{std::move(what)} {
        next(Clock::now());
    }

private:
    void next(Clock::time_point from) {
        // Late ticks are left out, not made up for.
        const Clock::time_point at = std::max(from + period_, Clock::now());
        timer_.expires_at(at);
        timer_.async_wait([this, at](error_code error) {
            if (error) return;
            what_(Clock::now());
            next(at);
        });
    }

    net::steady_timer timer_;
    std::chrono::milliseconds period_;
    std::function<void(Clock::time_point)> what_;
};

/// The scout on a thread of its own: a machine that does not answer holds up no client.
class ScoutThread {
public:
    ScoutThread(Scout scout, std::function<void(std::vector<Sighting>)> found)
        : scout_{std::move(scout)}, found_{std::move(found)}, thread_{[this] { run(); }} {}
    ~ScoutThread() {
        {
            const std::lock_guard lock{mutex_};
            ending_ = true;
        }
        wake_.notify_all();
        thread_.join();
    }
    ScoutThread(const ScoutThread&) = delete;
    ScoutThread& operator=(const ScoutThread&) = delete;

private:
    void run() {
        for (std::unique_lock lock{mutex_};
             !wake_.wait_for(lock, bounds.machine_poll, [this] { return ending_; });) {
            lock.unlock();
            if (auto changed = scout_.look(Clock::now()); !changed.empty()) found_(std::move(changed));
            lock.lock();
        }
    }

    Scout scout_;
    std::function<void(std::vector<Sighting>)> found_;
    std::mutex mutex_{};
    std::condition_variable wake_{};
    bool ending_ = false;
    std::thread thread_;
};

Sandbox sandbox_of(const Options& options) {
    Sandbox sandbox;
    sandbox.processors = options.processors;
    sandbox.readable.push_back(options.directory);
    if (!options.black_boxes.empty()) sandbox.readable.push_back(options.black_boxes);
    if (!options.users.empty()) sandbox.readable.push_back(folder_of(options.users));
    if (!options.log.empty()) sandbox.writable.push_back(folder_of(options.log));
    return sandbox;
}

/// Memory is given back: big blocks of passwords and replies are mapped alone, and threads share their heaps.
void keep_memory_small() {
    ::mallopt(M_MMAP_THRESHOLD, 256 * 1024);
    ::mallopt(M_TRIM_THRESHOLD, 256 * 1024);
    ::mallopt(M_ARENA_MAX, 2);
}

/// Returns the context; null on the loopback. `fingerprint` receives the certificate's.
std::expected<std::shared_ptr<net::ssl::context>, std::string> tls_of(const Options& options,
                                                                      std::string& fingerprint) {
    if (options.loopback) return nullptr;
    CertificateFiles files{options.certificate, options.key};
    if (options.certificate.empty()) {
        auto own = own_certificate(options.state, options.address);
        if (!own) return std::unexpected(own.error());
        files = std::move(*own);
    }
    return tls_context(files, fingerprint);
}

/// The network's thread and the others, once they are there.
struct Threads {
    net::io_context* network = nullptr;
    Workers* logins = nullptr;
    Workers* runs = nullptr;
};

Outside outside_of(const Threads& threads, const Options& options) {
    Outside outside;
    outside.connect = [&threads](const std::string& socket, OnPacket receive, std::string& fault) {
        return connect_relay(*threads.network, socket, std::move(receive), fault);
    };
    outside.in_background = [&threads](std::function<bool()> work, std::function<void(bool)> done) {
        return threads.logins->post([&threads, work = std::move(work), done = std::move(done)] {
            net::post(*threads.network, [done, result = work()] { done(result); });
        });
    };
    outside.start = [&threads](std::function<void()> work) {
        static_cast<void>(threads.runs->post(std::move(work)));
    };
    outside.on_network = [&threads](std::function<void()> what) {
        net::post(*threads.network, std::move(what));
    };
    outside.directory = options.directory;
    outside.black_boxes = options.black_boxes;
    return outside;
}

} // namespace

int serve(const Options& options, std::ostream& out, std::ostream& errors) {
    const auto fail = [&](const std::string& fault) {
        return errors << "tappet-gateway: " << fault << std::endl, 2;
    };
    keep_memory_small();
    std::signal(SIGPIPE, SIG_IGN);
    if (!std::filesystem::is_directory(options.directory))
        return fail("there is no folder '" + options.directory +
                    "' for the sockets of machines; make it, or name another with --directory");
    auto access = access_of(options);
    if (!access) return fail(access.error());
    std::string fingerprint;
    const auto tls = tls_of(options, fingerprint);
    if (!tls) return fail(tls.error());

    // The hub outlives the io_context, whose connections use it to their end.
    Threads threads;
    Hub hub{std::move(*access), options.log, outside_of(threads, options)};
    net::io_context io{1};
    threads.network = &io;
    Server server{io, hub, tls->get()};
    if (const std::string fault = server.listen(options.address, options.port); !fault.empty())
        return fail(fault);
    net::signal_set signals{io, SIGTERM, SIGINT};
    signals.async_wait([&io](error_code error, int) {
        if (!error) io.stop();
    });

    Scout scout{options.directory};
    hub.see(scout.look(Clock::now()));
    const auto value_now = [&hub](const Asked& asked) { return hub.values_of(asked.machine, asked.line); };
    if (const std::string fault = hub.audit().open(value_now); !fault.empty()) return fail(fault);
    const auto without = apply(sandbox_of(options));
    if (!without) return fail(without.error());
    for (const std::string& each : *without)
        errors << "tappet-gateway: this kernel has no " << each << "; the gateway runs without it"
               << std::endl;

    Workers logins{bounds.logins_at_once, bounds.logins_waiting};
    Workers runs{bounds.runs, bounds.runs};
    threads.logins = &logins;
    threads.runs = &runs;
    ScoutThread scouts{std::move(scout), [&](std::vector<Sighting> found) {
                           net::post(io, [&hub, found = std::move(found)] { hub.see(found); });
                       }};
    const Every ticks{io, bounds.tick, [&hub](Clock::time_point now) { hub.tick(now); }};
    const Every seconds{io, std::chrono::seconds{1}, [&](Clock::time_point now) {
                            if (const std::string fault = hub.each_second(now); !fault.empty())
                                errors << "tappet-gateway: " << fault << std::endl;
                        }};
    const std::string place =
        (options.address.contains(':') ? "[" + options.address + "]" : options.address) + ":" +
        std::to_string(server.port());
    out << "tappet-gateway: " << (options.loopback ? "http://" : "https://") << place << ", machines of "
        << options.directory << (fingerprint.empty() ? "" : ", certificate SHA-256 " + fingerprint)
        << std::endl;
    io.run();
    hub.close();
    return 0;
}

} // namespace tappet::network
