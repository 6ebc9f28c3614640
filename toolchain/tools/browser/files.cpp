// Reads and writes the files of a line.
#include "toolchain/tools/browser/files.hpp"

#include "toolchain/tools/browser/record_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace tappet::browser {

namespace {

/// Sends each part at once.
class FarFile final : public GrowingFile {
public:
    FarFile(std::string name, const FarFiles::Put& put) : name_{std::move(name)}, put_{put} {}
    void write(std::string bytes) override {
        for (std::string_view rest = bytes; !rest.empty() && fault_.empty();) {
            send(rest.substr(0, FarFiles::most_in_a_part), false);
            rest.remove_prefix(std::min(FarFiles::most_in_a_part, rest.size()));
        }
    }
    [[nodiscard]] bool is_behind() const override { return false; }
    [[nodiscard]] std::string fault() const override { return fault_; }
    Result<void> finish() override {
        if (fault_.empty()) send({}, true);
        return fault_.empty() ? Result<void>{} : wrong(fault_);
    }

private:
    void send(std::string_view part, bool last) {
        if (!put_(name_, part, last))
            fault_ = "'" + name_ + "' did not reach its user, whose program has gone";
    }

    std::string name_;
    const FarFiles::Put& put_;
    std::string fault_{};
};

} // namespace

Result<std::string> LocalFiles::read(const std::string& name) {
    std::ifstream file{name, std::ios::binary};
    if (!file) return wrong("'" + name + "' cannot be opened; is it there?");
    std::string bytes{std::istreambuf_iterator<char>{file}, std::istreambuf_iterator<char>{}};
    if (file.bad()) return wrong("'" + name + "' cannot be read");
    return bytes;
}

Result<void> LocalFiles::write(const std::string& name, const std::string& bytes) {
    std::ofstream file{name, std::ios::binary};
    file << bytes;
    file.close();
    if (file) return {};
    return wrong("'" + name +
                 "' could not be written; check that its folder exists and that you may write there");
}

Result<std::unique_ptr<GrowingFile>> LocalFiles::create(const std::string& name) {
    return RecordFile::create(name);
}

bool LocalFiles::exists(const std::string& name) { return std::filesystem::exists(name); }

Result<std::string> FarFiles::read(const std::string& name) {
    const auto found = given_.find(name);
    if (found == given_.end()) return wrong("'" + name + "' did not come with the line; is it there?");
    return found->second;
}

Result<void> FarFiles::write(const std::string& name, const std::string& bytes) {
    FarFile file{name, put_};
    file.write(bytes);
    return file.finish();
}

Result<std::unique_ptr<GrowingFile>> FarFiles::create(const std::string& name) {
    return std::make_unique<FarFile>(name, put_);
}

} // namespace tappet::browser
