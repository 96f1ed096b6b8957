// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/multifrontal.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "fem/factor/blas.hpp"
#include "fem/factor/dense_cholesky.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Rows and columns of a tile of a front. Fixed: the bits depend on it.
constexpr int kTile = 256;

int tiles_of(int rows) {
  return (rows + kTile - 1) / kTile;
}

/// A dense column-major matrix; each column starts `stride` numbers after the last.
template <class Number>
struct Block {
  Number* first;
  int stride;

  Number* operator()(int row, int column) const {
    return first + row + static_cast<std::ptrdiff_t>(column) * stride;
  }
};

/// Rows [first, last) below the diagonal: L21 = A21 L11^-T.
template <class Number>
void divide_rows(const Block<Number>& L, int columns, int first, int last) {
  Blas<Number>::trsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, last - first,
                     columns, 1, L.first, L.stride, L(first, 0), L.stride);
}

/// Columns [first, last) of U -= L21 L21^T, lower triangle; `below` rows in all.
template <class Number>
void subtract_product(const Block<Number>& L, int columns, const Block<Number>& U, int below,
                      int first, int last) {
  const Number* rows = L(columns + first, 0);
  Blas<Number>::syrk(CblasColMajor, CblasLower, CblasNoTrans, last - first, columns, -1, rows,
                     L.stride, 1, U(first, first), U.stride);
  if (last == below) return;
  Blas<Number>::gemm(CblasColMajor, CblasNoTrans, CblasTrans, below - last, last - first, columns,
                     -1, L(columns + last, 0), L.stride, rows, L.stride, 1, U(last, first),
                     U.stride);
}

}  // namespace

/// A running factorization.
template <class Number>
class Elimination {
 public:
  Elimination(const Multifrontal& order, const std::vector<double>& values,
              const EliminationPlan& plan, const Multifrontal::Finished<Number>& finished,
              const Multifrontal::Left<Number>& left, FrontMemory<Number>& memory)
      : order_(order),
        tree_(order.tree_),
        values_(values),
        finished_(finished),
        left_over_(left),
        left_(plan.parts.size() + plan.top.size()),
        memory_(memory),
        update_(tree_.parent.size()),
        awaited_(tree_.parent.size(), 0) {
    ready_.assign(plan.parts.begin(), plan.parts.end());
    for (const int k : plan.top)
      awaited_[to_index(k)] = static_cast<int>(tree_.children[to_index(k)].size());
  }

  bool run(int threads) {
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back([this] { serve(); });
    serve();
    for (std::thread& thread : others) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    return definite_;
  }

 private:
  /// Scratch memory of a thread.
  struct Workspace {
    std::vector<int> position;    ///< in the front, of the rows of the matrix
    std::vector<int> target;      ///< in the front, of the rows of a child
    LargeVector<Number> columns;  ///< of L
  };

  /// Tiles of one front, for any thread that has nothing else to do.
  struct Tiles {
    int count;
    const std::function<void(int)>& work;
    int next = 0, done = 0;
  };

  void serve() {
    Workspace own;
    own.columns = memory_.take_scratch();
    std::unique_lock lock(mutex_);
    while (left_ > 0 && definite_ && !failure_) {
      if (Tiles* tiles = unfinished_tiles()) {
        help(*tiles, lock);
      } else if (!ready_.empty()) {
        const std::vector<int> part = std::move(ready_.front());
        ready_.pop_front();
        lock.unlock();
        const bool done = eliminate_safely(part, own);
        lock.lock();
        if (done) count_child(part.back());
        --left_;
        changed_.notify_all();
      } else {
        changed_.wait(lock);
      }
    }
    lock.unlock();
    memory_.leave_scratch(std::move(own.columns));
  }

  /// After the last supernode of a part, or one of the top: its parent is ready with its last
  /// child.
  void count_child(int child) {
    const int parent = tree_.parent[to_index(child)];
    if (parent >= 0 && --awaited_[to_index(parent)] == 0) ready_.push_front({parent});
  }

  bool eliminate_safely(const std::vector<int>& part, Workspace& own) {
    try {
      if (std::all_of(part.begin(), part.end(), [&](int k) { return eliminate(k, own); }))
        return true;
      const std::lock_guard lock(mutex_);
      definite_ = false;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
    return false;
  }

  /// Assembles the front of supernode k, eliminates it, passes the columns on and stores the update
  /// for the parent.
  bool eliminate(int k, Workspace& own) {
    const int columns = tree_.columns[to_index(k)], rows = tree_.rows[to_index(k)],
              below = tree_.below(k);
    const std::size_t numbers = to_index(rows) * to_index(columns);
    if (own.columns.capacity() < numbers)
      own.columns = LargeVector<Number>();  // free the old block first
    own.columns.assign(numbers, Number{0});
    update_[to_index(k)] = memory_.zeros(to_index(below) * to_index(below));
    const Block<Number> L{own.columns.data(), rows}, U{update_[to_index(k)].data(), below};
    assemble(k, L, U, own);
    if (!factorize_in_place(L.first, columns, rows)) return false;
    in_tiles(tiles_of(below), [&](int tile) {
      divide_rows(L, columns, columns + tile * kTile,
                  columns + std::min(below, (tile + 1) * kTile));
    });
    in_tiles(tiles_of(below), [&](int tile) {
      subtract_product(L, columns, U, below, tile * kTile, std::min(below, (tile + 1) * kTile));
    });
    finished_(k, own.columns.data());
    if (tree_.parent[to_index(k)] < 0 && below > 0) {
      left_over_(k, U.first);
      memory_.give_back(std::move(update_[to_index(k)]));
    }
    return true;
  }

  void assemble(int k, const Block<Number>& L, const Block<Number>& U, Workspace& own) {
    const int* rows = order_.view_.rows + order_.view_.row_start[k];
    own.position.resize(order_.entry_start_.size());
    for (int i = 0; i < tree_.rows[to_index(k)]; ++i) own.position[to_index(rows[i])] = i;
    for (int j = 0; j < tree_.columns[to_index(k)]; ++j) {
      const std::size_t column = to_index(order_.view_.first_column[k] + j);
      for (std::size_t e = order_.entry_start_[column]; e < order_.entry_start_[column + 1]; ++e) {
        const auto& entry = order_.entries_[e];
        *L(own.position[to_index(entry.row)], j) =
            static_cast<Number>(values_[to_index(entry.value)]);
      }
    }
    for (const int child : tree_.children[to_index(k)])
      add_update_of(child, L, U, tree_.columns[to_index(k)], own);
  }

  /// Both have their rows in ascending order: an entry below the diagonal stays below it.
  void add_update_of(int child, const Block<Number>& L, const Block<Number>& U, int columns,
                     Workspace& own) {
    const int below = tree_.below(child);
    const int* rows =
        order_.view_.rows + order_.view_.row_start[child] + tree_.columns[to_index(child)];
    own.target.resize(to_index(below));
    for (int i = 0; i < below; ++i) own.target[to_index(i)] = own.position[to_index(rows[i])];
    const int* target = own.target.data();
    const Number* source = update_[to_index(child)].data();
    for (int j = 0; j < below; ++j, source += below) {
      Number* to = target[j] < columns ? L(0, target[j]) : U(0, target[j] - columns) - columns;
      for (int i = j; i < below; ++i) to[target[i]] += source[i];
    }
    memory_.give_back(std::move(update_[to_index(child)]));
  }

  Tiles* unfinished_tiles() {
    const auto open = std::find_if(tiles_.begin(), tiles_.end(),
                                   [](const Tiles* t) { return t->next < t->count; });
    return open == tiles_.end() ? nullptr : *open;
  }

  void help(Tiles& tiles, std::unique_lock<std::mutex>& lock) {
    const int mine = tiles.next++;
    lock.unlock();
    tiles.work(mine);
    lock.lock();
    if (++tiles.done == tiles.count) changed_.notify_all();
  }

  /// Calls `work` for each of `count` tiles, on this thread and on waiting ones.
  void in_tiles(int count, const std::function<void(int)>& work) {
    if (count < 2) {
      if (count == 1) work(0);
      return;
    }
    Tiles tiles{count, work};
    std::unique_lock lock(mutex_);
    tiles_.push_back(&tiles);
    changed_.notify_all();
    while (tiles.next < tiles.count) help(tiles, lock);
    changed_.wait(lock, [&] { return tiles.done == tiles.count; });
    std::erase(tiles_, &tiles);
  }

  const Multifrontal& order_;
  const EliminationTree& tree_;
  const std::vector<double>& values_;
  const Multifrontal::Finished<Number>& finished_;
  const Multifrontal::Left<Number>& left_over_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::vector<int>> ready_;  ///< parts and supernodes whose children are done
  std::size_t left_;                    ///< of parts and supernodes
  std::vector<Tiles*> tiles_;
  bool definite_ = true;
  std::exception_ptr failure_;

  FrontMemory<Number>& memory_;
  std::vector<LargeVector<Number>> update_;  ///< of each supernode, until its parent has added it
  std::vector<int> awaited_;  ///< children not yet eliminated, of a supernode of the top
};

Multifrontal::Multifrontal(const SparsePattern& pattern, const SupernodalView& view)
    : view_(view), tree_(view), entry_start_(to_index(pattern.n) + 1, 0) {
  std::vector<int> position(to_index(pattern.n));  // of the unknowns in the order of elimination
  for (int i = 0; i < pattern.n; ++i) position[to_index(view.permutation[i])] = i;
  const auto for_entries = [&](auto&& use) {
    for (int column = 0; column < pattern.n; ++column)
      for (int e = pattern.start[to_index(column)]; e < pattern.start[to_index(column) + 1]; ++e) {
        const auto [first, last] =
            std::minmax(position[to_index(column)], position[to_index(pattern.row[to_index(e)])]);
        if (first < view.first_column[view.supernodes]) use(to_index(first), Entry{last, e});
      }
  };
  for_entries([&](std::size_t column, Entry) { ++entry_start_[column + 1]; });
  for (std::size_t i = 1; i < entry_start_.size(); ++i) entry_start_[i] += entry_start_[i - 1];
  entries_.resize(entry_start_.back());
  std::vector<std::size_t> next(entry_start_.begin(), entry_start_.end() - 1);
  for_entries([&](std::size_t column, Entry entry) { entries_[next[column]++] = entry; });
}

template <class Number>
bool Multifrontal::factorize(const std::vector<double>& values, int threads,
                             const Finished<Number>& finished, const Left<Number>& left,
                             FrontMemory<Number>* memory) const {
  const EliminationPlan plan(tree_, threads);
  FrontMemory<Number> own;
  FrontMemory<Number>& used = memory != nullptr ? *memory : own;
  if (memory == nullptr) own.keep_at_most(sizeof(Number) * plan.update_numbers);
  return Elimination<Number>(*this, values, plan, finished, left, used).run(threads);
}

template bool Multifrontal::factorize(const std::vector<double>&, int, const Finished<float>&,
                                      const Left<float>&, FrontMemory<float>*) const;
template bool Multifrontal::factorize(const std::vector<double>&, int, const Finished<double>&,
                                      const Left<double>&, FrontMemory<double>*) const;

}  // namespace palpate::fem
