// SPDX-License-Identifier: AGPL-3.0-or-later
// What the force step asks of the system: no page, no call.
#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>

#include "tests/realtime/ride.hpp"

namespace palpate::test {
namespace {

const runtime::ContactSettings kSettings{0.2, 0, runtime::EnergyBudget::Enforced, 400};

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

TEST(Step, TakesNoPageFault) {
  palpate_state first(ride_body(), kSettings);
  ride(first);  // brings in the pages of code, stack and tables, as mlockall does for a force loop
  palpate_state state(ride_body(), kSettings);
  const long before = page_faults();
  const std::uint32_t seen = ride(state);
  EXPECT_EQ(page_faults() - before, 0);
  EXPECT_EQ(seen & ride_bits(), ride_bits());
}

TEST(Step, TheFaultsAreCounted) {
  constexpr std::size_t kPage = 4096;
  const long before = page_faults();
  std::vector<char> fresh(4000 * kPage, 1);  // 16 MB: not from memory in use before
  EXPECT_GT(page_faults() - before, 7);
  EXPECT_EQ(fresh[123], 1);
}

/// From here on a system call other than the end of the process ends it by SIGSYS.
bool forbid_system_calls() {
  const auto number = static_cast<__u32>(offsetof(seccomp_data, nr));
  std::array<sock_filter, 4> program{{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, number),
                                      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 0, 1),
                                      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
                                      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS)}};
  const sock_fprog filter{program.size(), program.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

constexpr int kDone = 0;
constexpr int kNothingSeen = 3;
constexpr int kNoFilter = 4;

/// Status of a child process that does `work` without system calls.
template <class Work>
int status_without_calls(Work work) {
  const pid_t child = fork();
  if (child == 0) _exit(forbid_system_calls() ? work() : kNoFilter);
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(Step, MakesNoSystemCall) {
  palpate_state state(ride_body(), kSettings);
  const int status = status_without_calls(
      [&] { return (ride(state) & ride_bits()) == ride_bits() ? kDone : kNothingSeen; });
  EXPECT_FALSE(WIFSIGNALED(status)) << "ended by signal " << WTERMSIG(status);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_NE(WEXITSTATUS(status), kNoFilter) << "this system has no seccomp filters";
  EXPECT_EQ(WEXITSTATUS(status), kDone);
}

TEST(Step, ASystemCallWouldBeNoticed) {
  const int status = status_without_calls([] { return getppid() == 1 ? 1 : 2; });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGSYS);
}

}  // namespace
}  // namespace palpate::test
