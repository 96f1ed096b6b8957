// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/doctor/machine.hpp"

#include <dlfcn.h>
#include <sched.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>
#include <thread>

#include "runtime/realtime.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

int usable_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(std::thread::hardware_concurrency());
}

/// MemAvailable of the kernel, bytes; 0 where it is not stated.
double available_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    double kib = 0;
    if (words >> key >> kib && key == "MemAvailable:") return 1024 * kib;
  }
  return 0;
}

bool has_realtime_kernel() {
  std::ifstream file("/sys/kernel/realtime");
  int value = 0;
  return static_cast<bool>(file >> value) && value == 1;
}

/// How late the steps of a loop of 1 kHz begin that wakes `early` (ns), s: in the median, and at
/// worst.
void measure_loop(std::int64_t early, double& median, double& worst) {
  constexpr std::int64_t period = 1'000'000;  // ns
  constexpr std::size_t steps = 500;
  std::vector<double> late(steps);
  std::int64_t due = runtime::monotonic_ns();
  for (double& delay : late) {
    due += period;
    runtime::wait_until(due, early);
    delay = 1e-9 * static_cast<double>(runtime::monotonic_ns() - due);
  }
  std::sort(late.begin(), late.end());
  median = late[steps / 2];
  worst = late.back();
}

/// Two loops in a thread that asks for what the force loop asks for.
void measure_loops(Machine& machine) {
  std::thread loop([&machine] {
    machine.realtime_refusal = runtime::become_realtime({});
    measure_loop(0, machine.late_median, machine.late_worst);
    measure_loop(400'000, machine.early_median, machine.early_worst);
  });
  loop.join();
}

bool is_library(std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [](const char* name) {
    void* handle = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (handle != nullptr) dlclose(handle);
    return handle != nullptr;
  });
}

bool is_program(std::initializer_list<const char*> names) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* name : names)
      if (access((fs::path(folder) / name).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace

Machine look_at_machine(const std::string& blas_kernel) {
  Machine machine;
  machine.processors = usable_processors();
  machine.memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  machine.available = available_memory();
  machine.blas_kernel = blas_kernel;
  machine.realtime_kernel = has_realtime_kernel();
  measure_loops(machine);
  machine.libraries = {
      {"Force Dimension SDK", "devices of Force Dimension", "install it (libdhd.so)",
       is_library({"libdhd.so.3", "libdhd.so"})},
      {"OpenHaptics", "Touch and Phantom", "install it with its device driver (libHD.so)",
       is_library({"libHD.so", "libHD.so.3.4"})},
      {"Comedi", "lab-built devices", "apt install libcomedi0", is_library({"libcomedi.so.0"})}};
  machine.programs = {
      {"CalculiX", "solves `palpate export site` decks", "apt install calculix-ccx",
       is_program({"ccx"})},
      {"ParaView", "shows faulty faces and .vtkhdf files", "apt install paraview",
       is_program({"paraview"})},
      {"web browser", "shows report.html", "apt install chromium, or open the report elsewhere",
       is_program({"chromium", "chromium-browser", "google-chrome", "firefox", "firefox-esr"})}};
  machine.folder = fs::current_path().string();
  struct statvfs disk {};
  if (statvfs(machine.folder.c_str(), &disk) == 0)
    machine.free_disk = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  return machine;
}

}  // namespace palpate::app
