// A small machine as a browser sees it, controlled by the test: a block of memory with a map, and a socket
// that answers by the test's rules.
#pragma once

#include "kernel/machine/map/layout.hpp"
#include "kernel/services/browsing/protocol.hpp"
#include "tests/toolchain/folder.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace tappet::browser {

/// Builds a block: texts and sections first, values after them.
class SampleMap {
public:
    SampleMap();

    std::uint32_t activity(std::string_view name);
    std::uint32_t component(std::string_view name, std::string_view type, std::uint32_t activity,
                            std::string_view device = "");
    /// Adds a facet to the last component.
    std::uint32_t facet(std::string_view name, std::string_view kind, std::uint32_t type,
                        std::string_view unit = {}, std::string_view doc = {}, std::uint32_t flags = 0);
    std::uint32_t type(std::string_view name, map::Shape shape, std::uint64_t size);
    std::uint32_t enumeration(std::string_view name, std::uint64_t size,
                              const std::vector<std::pair<std::string_view, std::int64_t>>& names);
    std::uint32_t record(std::string_view name,
                         const std::vector<std::pair<std::string_view, std::uint32_t>>& fields,
                         map::Shape shape = map::Shape::record);
    std::uint32_t matrix(std::uint32_t element, std::uint32_t rows, std::uint32_t columns, bool row_major);
    std::uint32_t text_type(std::uint32_t capacity);
    std::uint32_t sequence(std::uint32_t element, std::uint32_t capacity);
    void connect(std::uint32_t from, std::uint32_t to, std::int64_t max_age_ns);
    void react(std::string_view how, std::uint32_t from, std::uint32_t to);
    void figure(map::Owner owner, std::uint32_t index, std::string_view name, std::uint32_t type);

    /// Lays everything out and returns the block.
    std::vector<std::byte> build();

    [[nodiscard]] const std::vector<map::Facet>& facets() const { return facets_; }
    [[nodiscard]] const std::vector<map::Activity>& activities() const { return activities_; }
    [[nodiscard]] const map::Header& header() const { return header_; }
    std::uint32_t f64 = 0, i32 = 0, u8 = 0, boolean = 0, duration = 0; ///< types that are always there

private:
    map::Text text(std::string_view text);
    template <class Record> map::Section lay(std::vector<std::byte>& block,
                                             const std::vector<Record>& records);
    std::uint64_t take(std::uint64_t bytes);

    map::Header header_{};
    std::string texts_{};
    std::vector<map::Component> components_{};
    std::vector<map::Facet> facets_{};
    std::vector<map::Activity> activities_{};
    std::vector<map::Connection> connections_{};
    std::vector<map::Reaction> reactions_{};
    std::vector<map::Behaviour> behaviours_{};
    std::vector<map::Type> types_{};
    std::vector<map::Field> fields_{};
    std::vector<map::Enumerator> enumerators_{};
    std::vector<map::Figure> figures_{};
    std::uint64_t end_ = 0;
};

/// A loom's shaft and its lamp, in shared memory, served at a socket of a temporary folder.
class SampleMachine {
public:
    SampleMachine();
    ~SampleMachine();
    SampleMachine(const SampleMachine&) = delete;
    SampleMachine& operator=(const SampleMachine&) = delete;

    [[nodiscard]] const std::string& socket() const { return path_; }
    [[nodiscard]] const std::string& directory() const { return directory_.string(); }
    /// Writes a value as the machine would: the generation of its activity is odd meanwhile.
    template <class T> void write(std::string_view facet, const T& value, std::int64_t stamp_ns = 1000) {
        write_bytes(facet, std::as_bytes(std::span{&value, 1}), stamp_ns);
    }
    void force(std::string_view facet, bool forced, double value);
    /// Holds the activity of a facet in a cycle until it is released.
    void hold(std::string_view facet, bool in_cycle);
    void set_now(std::string_view facet, std::int64_t now_ns);
    /// Sets the answer, one packet each, to requests with this beginning (after the number); "%" stands for
    /// the number. All other requests get an "ok".
    void answer(std::string_view request, std::vector<std::string> packets);
    [[nodiscard]] std::vector<std::string> requests() const;
    /// The requests after those that open a session.
    [[nodiscard]] std::vector<std::string> asked() const;
    /// The memory as the machine's guardian sees it.
    [[nodiscard]] std::span<const std::byte> memory() const { return block_; }
    /// Closes every connection, as a machine does at its end.
    void end();

    std::string role = "engineer";

private:
    void write_bytes(std::string_view facet, std::span<const std::byte> bytes, std::int64_t stamp_ns);
    void serve();
    void reply(int client, std::string_view packet);
    std::uint32_t index_of(std::string_view facet) const;
    std::atomic_ref<std::uint64_t> generation(std::uint32_t facet) const;

    SampleMap map_{};
    std::map<std::string, std::uint32_t, std::less<>> names_{};
    std::map<std::uint32_t, std::uint32_t> activity_of_{};
    int memory_ = -1;
    std::span<std::byte> block_{};
    test::Folder directory_{};
    std::string path_{};
    int listener_ = -1;
    std::atomic<bool> ending_{false};
    mutable std::mutex mutex_{};
    std::vector<std::pair<std::string, std::vector<std::string>>> answers_{};
    std::vector<std::string> requests_{};
    std::thread server_{};
};

} // namespace tappet::browser
