// The .npz format of NumPy (numpy.load): a .npy file for each list of the answer, and answer.json
// with the rest.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "api/cancellation.hpp"
#include "api/format/answer_list.hpp"
#include "api/format/encode.hpp"

namespace vines::api {

namespace {

void put_little(std::string& to, std::uint64_t number, int bytes) {
    for (int k = 0; k < bytes; ++k) to += static_cast<char>(number >> (8 * k) & 0xff);
}

/// A ZIP archive of uncompressed files (PKWARE APPNOTE, 4.3).
class Archive {
public:
    void add(const std::string& name, const std::string& content) {
        const auto crc = ::crc32(
            0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
        std::string common;
        put_little(common, 20, 2);          // version needed to extract
        put_little(common, 0x0800, 2);      // names in UTF-8
        put_little(common, 0, 2);           // stored
        put_little(common, 0x00210000, 4);  // 1980-01-01: the same answer has the same bytes
        put_little(common, crc, 4);
        put_little(common, content.size(), 4);
        put_little(common, content.size(), 4);
        put_little(common, name.size(), 2);
        put_little(common, 0, 2);  // no extra field
        directory_ += "PK\x01\x02";
        put_little(directory_, 20, 2);
        directory_ += common;
        directory_.append(10, '\0');  // no comment, first disk, attributes
        put_little(directory_, files_.size(), 4);
        directory_ += name;
        files_ += "PK\x03\x04" + common + name + content;
        ++number_;
    }
    std::string end() {
        std::string tail = "PK\x05\x06";
        put_little(tail, 0, 4);
        put_little(tail, number_, 2);
        put_little(tail, number_, 2);
        put_little(tail, directory_.size(), 4);
        put_little(tail, files_.size(), 4);
        put_little(tail, 0, 2);
        return std::move(files_) + directory_ + tail;
    }

private:
    std::string files_, directory_;
    std::size_t number_ = 0;
};

/// The NPY format, version 1.0. The header is padded to a multiple of 64 bytes.
std::string npy(const std::string& type, const std::string& shape, std::string_view data) {
    std::string header =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
    constexpr std::size_t before = 10, step = 64;
    header.resize((before + header.size() + step) / step * step - before - 1, ' ');
    std::string file = "\x93NUMPY";
    put_little(file, 1, 2);
    put_little(file, header.size() + 1, 2);
    return file + header + '\n' + std::string(data);
}

std::string shape_of(const AnswerList& list) {
    switch (list.packing()) {
        case Packed::quadruples: return fmt::format("({}, 4)", list.size());
        case Packed::matrices: return fmt::format("({}, 4, 4)", list.size());
        default: return fmt::format("({},)", list.size());
    }
}

/// Strings in UCS-4. All strings of lists are ASCII.
std::string npy_of_words(const AnswerList& list) {
    std::size_t longest = 1;
    for (const std::string& word : list.words()) longest = std::max(longest, word.size());
    std::string data;
    for (const std::string& word : list.words())
        for (std::size_t k = 0; k < longest; ++k)
            put_little(data, k < word.size() ? static_cast<unsigned char>(word[k]) : 0, 4);
    return npy(fmt::format("<U{}", longest), shape_of(list), data);
}

std::string npy_of(const AnswerList& list) {
    if (list.packing() == Packed::no) return npy_of_words(list);
    const auto file = [&list](const char* type, std::span<const std::uint8_t> bytes) {
        return npy(
            type, shape_of(list), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    switch (list.packing()) {
        case Packed::flags: return file("|b1", list.bytes());
        case Packed::integers: return file("<i4", list.bytes());
        default: {
            std::vector<std::uint8_t> doubles(list.bytes().begin(), list.bytes().end());
            nan_for_null(doubles);
            return file("<f8", doubles);
        }
    }
}

/// Calls visit(path, list) for each list of an answer, in order; a path joins names with points.
/// Lists of objects are skipped.
template <class Visit>
void visit_lists(const Json& answer, const Visit& visit, const std::string& path = "") {
    if (answer.is_object()) {
        for (const auto& [name, part] : answer.items())
            visit_lists(part, visit, path.empty() ? name : path + "." + name);
    } else if (const std::optional<AnswerList> list = AnswerList::of(answer)) {
        visit(path, *list);
    }
}

/// Removes the lists, which have their own files.
void take_out_lists(Json& object) {
    std::vector<std::string> lists;
    for (auto& [name, value] : object.items()) {
        if (value.is_object()) take_out_lists(value);
        else if (value.is_binary()) lists.push_back(name);
    }
    for (const std::string& name : lists) object.erase(name);
}

}  // namespace

std::string npz_bytes(
    Json answer, const std::function<bool()>& gives_up, const Json& only_in_files) {
    const CancelCheck cancel(gives_up);
    Archive archive;
    const auto add = [&](const std::string& path, const AnswerList& list) {
        cancel.poll();
        if (path.find('.') != std::string::npos) archive.add(path + ".npy", npy_of(list));
    };
    visit_lists(answer, add);
    visit_lists(only_in_files, add);
    take_out_lists(answer);
    archive.add("answer.json", json_text(std::move(answer)) + "\n");
    return archive.end();
}

}  // namespace vines::api
