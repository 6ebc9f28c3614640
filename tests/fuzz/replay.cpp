// Runs a fuzz target over given files and folders: past findings are tested for ever, with any compiler.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

void replay(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    const std::vector<char> bytes{std::istreambuf_iterator<char>{file}, {}};
    std::cout << path.filename().string() << std::endl; // flushed: the last name is the file that broke
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

} // namespace

int main(int count, char** words) {
    std::size_t replayed = 0;
    for (int i = 1; i < count; ++i)
        for (const auto& each : std::filesystem::recursive_directory_iterator{words[i]}) {
            if (!each.is_regular_file()) continue;
            replay(each.path());
            ++replayed;
        }
    std::cout << replayed << " inputs replayed\n";
    return replayed == 0 ? 1 : 0;
}
