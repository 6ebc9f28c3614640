// A recording ends unexpectedly: its writer is killed, or the disk is full. The file then holds whole
// records, from the first one on, and loses at most the last second.
#include "toolchain/tools/browser/mcap.hpp"
#include "toolchain/tools/browser/record_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <new>
#include <random>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::browser {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;
using testing::HasSubstr;

std::uint64_t now_ns() { return static_cast<std::uint64_t>(steady_clock::now().time_since_epoch().count()); }

/// A program that records in a process of its own, and its reports.
class Recorder {
public:
    Recorder() {
        void* place =
            ::mmap(nullptr, sizeof(Told), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        told_ = new (place) Told;
        char name[] = "/tmp/tappet_record_XXXXXX";
        ::close(::mkstemp(name));
        std::filesystem::remove(name);
        file = std::string{name} + ".mcap";
    }
    ~Recorder() {
        if (child_ > 0) kill_it();
        std::filesystem::remove(file);
        ::munmap(told_, sizeof(Told));
    }
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Starts the process, in which `first` runs before the recording.
    void start(const std::function<void()>& first = [] {}) {
        child_ = ::fork();
        ASSERT_GE(child_, 0);
        if (child_ > 0) return;
        first();
        ::_exit(write_on(*told_));
    }
    void kill_it() {
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
        child_ = 0;
    }
    [[nodiscard]] int wait_for_it() {
        int status = 0;
        ::waitpid(child_, &status, 0);
        child_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    [[nodiscard]] std::string fault() const { return told_->fault; }
    /// Number of the messages that were handed over.
    [[nodiscard]] std::uint64_t count() const { return told_->count.load(); }

    std::string file{};

private:
    struct Told {
        std::atomic<std::uint64_t> count{0};
        char fault[300]{};
    };

    /// Records as 'report start' does.
    int write_on(Told& told) const {
        auto record = RecordFile::create(file);
        if (!record) return 2;
        std::string bytes;
        mcap::put_begin(bytes, "test");
        mcap::put_channel(bytes, {1, 0, "axis.position", "json", {}});
        while ((*record)->fault().empty()) {
            for (int i = 0; i < 100; ++i) {
                const auto sequence = static_cast<std::uint32_t>(told.count.load());
                mcap::put_message(bytes, {1, sequence, now_ns(), R"({"value": 0.25})"});
                told.count.store(sequence + 1);
            }
            (*record)->write(std::exchange(bytes, {}));
            std::this_thread::sleep_for(10ms);
        }
        const auto done = (*record)->finish();
        std::strncpy(told.fault, done ? "" : done.error().sentence.c_str(), sizeof told.fault - 1);
        return done ? 3 : 0;
    }

    Told* told_ = nullptr;
    pid_t child_ = 0;
};

/// The times of all messages in a file, which must be a beginning of the recording.
std::vector<std::uint64_t> times_in(const std::string& name) {
    const auto bytes = LocalFiles{}.read(name);
    if (!bytes) return {};
    const auto contents = mcap::read(*bytes);
    EXPECT_TRUE(contents.has_value()) << contents.error();
    if (!contents) return {};
    EXPECT_FALSE(contents->has_end);
    std::vector<std::uint64_t> times;
    for (const mcap::Message& each : contents->messages) {
        EXPECT_EQ(each.sequence, times.size());
        EXPECT_EQ(each.data, R"({"value": 0.25})");
        times.push_back(each.log_ns);
    }
    return times;
}

// Several rounds exclude delays by a busy host: one good round is enough.
TEST(RecordFile, is_complete_up_to_the_last_second_when_its_writer_is_killed) {
    std::mt19937_64 random{5};
    std::uint64_t least_lag = ~std::uint64_t{0};
    for (int round = 0; round < 6; ++round) {
        Recorder recorder;
        recorder.start();
        std::size_t before = 0;
        for (int i = 0; i < 3000 && before == 0; ++i) {
            std::this_thread::sleep_for(10ms);
            before = std::filesystem::exists(recorder.file) ? times_in(recorder.file).size() : 0;
        }
        ASSERT_GT(before, 0u);
        std::this_thread::sleep_for(std::chrono::milliseconds{random() % 700});
        recorder.kill_it();
        const std::uint64_t killed = now_ns();
        const auto times = times_in(recorder.file);
        ASSERT_GE(times.size(), before);
        ASSERT_LE(times.size(), recorder.count());
        least_lag = std::min(least_lag, killed - times.back());
        if (least_lag < 1'000'000'000 && round > 2) break;
    }
    EXPECT_LT(least_lag, 1'000'000'000u);
}

TEST(RecordFile, reports_a_full_disk_and_is_complete_up_to_there) {
    for (const rlim_t most : {20'000u, 20'013u, 20'031u}) { // limits that cut a record
        Recorder recorder;
        recorder.start([most] { // as on a full disk: the last write is short
            ::signal(SIGXFSZ, SIG_IGN);
            const rlimit room{most, most};
            ::setrlimit(RLIMIT_FSIZE, &room);
        });
        ASSERT_EQ(recorder.wait_for_it(), 0);
        EXPECT_THAT(recorder.fault(), HasSubstr("' cannot be written: "));
        EXPECT_THAT(recorder.fault(), HasSubstr("; its contents up to that point are good"));
        EXPECT_EQ(std::filesystem::file_size(recorder.file), most);
        const auto times = times_in(recorder.file);
        EXPECT_GT(times.size(), 300u);
        EXPECT_LT(times.size(), recorder.count());
    }
}

TEST(RecordFile, is_free_again_after_its_writer_was_killed) {
    Recorder recorder;
    recorder.start();
    for (int i = 0; i < 3000 && !std::filesystem::exists(recorder.file); ++i)
        std::this_thread::sleep_for(10ms);
    recorder.kill_it();
    const auto stopped = stop_recording(recorder.file);
    ASSERT_FALSE(stopped);
    EXPECT_THAT(stopped.error().sentence, HasSubstr("nobody records into"));
}

TEST(RecordFile, is_not_stopped_by_ending_a_process_that_locks_it_for_other_reasons) {
    const std::string file = std::filesystem::temp_directory_path() / "tappet-foreign-XXXXXX";
    std::string name = file;
    const int descriptor = ::mkstemp(name.data());
    ASSERT_GE(descriptor, 0);
    int locked[2] = {-1, -1};
    ASSERT_EQ(::pipe(locked), 0);
    const pid_t stranger = ::fork();
    if (stranger == 0) {
        struct flock lock{};
        lock.l_type = F_WRLCK; // the whole file
        lock.l_whence = SEEK_SET;
        const char done = ::fcntl(descriptor, F_SETLK, &lock) == 0 ? 'y' : 'n';
        static_cast<void>(::write(locked[1], &done, 1) == 1);
        for (;;) ::pause();
    }
    char done = 0;
    ASSERT_EQ(::read(locked[0], &done, 1), 1);
    ASSERT_EQ(done, 'y');
    const auto stopped = stop_recording(name);
    ASSERT_FALSE(stopped);
    EXPECT_THAT(stopped.error().sentence, HasSubstr("is locked by something that is no 'report start'"));
    int status = 0;
    EXPECT_EQ(::waitpid(stranger, &status, WNOHANG), 0) << "it lives";
    ::kill(stranger, SIGKILL);
    ::waitpid(stranger, &status, 0);
    for (const int each : {descriptor, locked[0], locked[1]}) ::close(each);
    std::filesystem::remove(name);
}

} // namespace
} // namespace tappet::browser
