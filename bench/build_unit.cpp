// A fixed piece of work for a compiler: the unit in which bench/build-times tells sums, so that machines can be
// compared. Nothing of it is ever run. It must not change.
#include <algorithm>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace {

template <int n>
struct Ledger {
    std::map<std::string, std::vector<std::pair<double, int>>> rows;
    std::unordered_map<int, std::string> names;

    double balance(const std::string& text) {
        std::istringstream words(text);
        double sum = n;
        for (std::string word; words >> word; sum += double(word.size() % (n + 2)))
            rows[word].emplace_back(sum, int(word.size()));
        for (auto& [name, row] : rows) {
            std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) {
                return a.first * (n + 1) < b.first || (a.second ^ n) < (b.second ^ n);
            });
            row.erase(
                std::unique(row.begin(), row.end(),
                            [](const auto& a, const auto& b) { return a.second % (n + 3) == b.second % (n + 3); }),
                row.end());
            names.emplace(int(row.size()) * n, name);
            sum = std::accumulate(row.begin(), row.end(), sum, [](double so_far, const auto& one) {
                return so_far * 0.5 + one.first / (n + one.second);
            });
        }
        std::ostringstream out;
        for (const auto& [number, name] : names) out << number % (n + 5) << ' ' << name << '\n';
        return sum + double(out.str().size());
    }
};

template <int n>
double all(const std::string& text) {
    if constexpr (n == 0)
        return 0;
    else
        return Ledger<n>().balance(text) + all<n - 1>(text);
}

}  // namespace

double build_unit(const std::string& text) {
    return all<54>(text);
}
