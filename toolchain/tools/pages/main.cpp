// tappet-pages refusals|reference TREE FILE: writes one of the pages that are generated from the code.
#include "toolchain/tools/pages/pages.hpp"

#include <fstream>
#include <iostream>

int main(int count, char** words) {
    const std::string_view what = count == 4 ? words[1] : "";
    if (what != "refusals" && what != "reference") {
        std::cerr << "usage: tappet-pages refusals|reference TREE FILE\n";
        return 2;
    }
    const auto page =
        what == "refusals" ? tappet::pages::refusals_page(words[2]) : tappet::pages::reference_page(words[2]);
    if (!page) {
        std::cerr << "tappet-pages: " << page.error() << '\n';
        return 1;
    }
    std::ofstream file{words[3], std::ios::binary};
    file << *page;
    if (file.flush()) return 0;
    std::cerr << "tappet-pages: cannot write " << words[3] << "; check the folder and the disk\n";
    return 1;
}
