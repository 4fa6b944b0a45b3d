// Lists of frames such as 0-299x5,7: their parsing and printing.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace cistula {

inline constexpr int largest_frame = 9'999'999;
inline constexpr size_t most_frames = 1'000'000;

/// A list of frames in the order in which they are rendered. It is held as runs of equal steps, so a film of a million
/// frames takes no more room than one of ten.
class FrameList {
  public:
    FrameList() = default;
    FrameList(std::initializer_list<int> frames);
    FrameList(const std::vector<int>& frames);

    void push_back(int frame);

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    int front() const { return runs_.front().first; }
    int operator[](size_t index) const;
    bool contains(int frame) const;

    /// The `count` frames from `begin` on, fewer where the list ends.
    std::vector<int> part(size_t begin, size_t count) const;

    friend FrameList first_frames(int count);
    friend bool operator==(const FrameList& a, const FrameList& b) { return a.runs_ == b.runs_; }

  private:
    /// The frames first, first + step, ...
    struct Run {
        size_t start;  // index of its first frame in the list
        int first, step;
        size_t count;
        bool operator==(const Run&) const = default;
    };

    std::vector<Run> runs_;
    size_t size_ = 0;
};

/// The first `count` frames, 1 or more, from 0.
FrameList first_frames(int count);

/// The frames of a comma-separated list of N, A-B and A-BxSTEP, in the order written, without duplicates. Throws Error
/// (usage) that quotes the wrong part and says what would be right.
FrameList parse_frames(std::string_view text);

/// A list as the command line takes it, of the frames from the index `begin` on: "1-3,7", "0-20x5".
std::string format_frames(const FrameList& frames, size_t begin = 0);

}  // namespace cistula
