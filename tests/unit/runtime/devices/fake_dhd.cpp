// SPDX-License-Identifier: AGPL-3.0-or-later
// A libdhd for tests, written from the documented C interface: SI units, failure below 0 with
// outputs untouched, 1 for an early sample, 2 for saturated motors.
#include "tests/unit/runtime/devices/fake_world.hpp"

namespace {

palpate::test::FakeWorld world;
int last_error = 0;
bool expert = false;

int fail(int error) {
  last_error = error;
  return -1;
}
bool gone() {
  return world.unplugged || world.opened <= world.closed;
}
int get(const palpate::Vec3& v, double* x, double* y, double* z) {
  if (gone()) return fail(2);
  *x = v[0], *y = v[1], *z = v[2];
  return world.late ? 1 : 0;
}

}  // namespace

palpate::test::FakeWorld* fake_world() {
  return &world;
}

extern "C" {

int dhdOpen() {
  if (!world.present) return fail(5);
  ++world.opened;
  return 0;
}
int dhdOpenID(char id) {
  return id == 0 ? dhdOpen() : fail(5);
}
int dhdClose(char) {
  ++world.closed;
  world.forces_enabled = false;
  return 0;
}
int dhdStop(char) {
  world.forces_enabled = false;
  world.force = {};
  return 0;
}
int dhdGetSystemType(char) {
  return gone() ? fail(2) : world.system_type.load();
}
int dhdGetPosition(double* x, double* y, double* z, char) {
  world.wait_for_device();
  return get(world.position(), x, y, z);
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char) {
  return get(world.velocity(), x, y, z);
}
int dhdSetForce(double x, double y, double z, char) {
  if (gone()) return fail(2);
  const bool motors = world.forces_enabled;
  world.send_force(motors ? palpate::Vec3{x, y, z} : palpate::Vec3{});
  return world.saturated ? 2 : 0;
}
int dhdEnableForce(unsigned char on, char) {
  world.forces_enabled = on != 0;
  return gone() ? fail(2) : 0;
}
int dhdGetButtonMask(char) {
  return gone() ? fail(2) : world.buttons.load();
}
int dhdEnableExpertMode() {
  if (!world.has_watchdog) return fail(9);
  expert = true;
  return 0;
}
int dhdSetWatchdog(unsigned char ticks, char) {
  if (!expert) return fail(9);
  world.watchdog_ticks = ticks;
  return 0;
}
int dhdErrorGetLast() {
  return last_error;
}
const char* dhdErrorGetStr(int error) {
  return error == 5 ? "no device found" : error == 2 ? "communication error" : "error";
}

}  // extern "C"
