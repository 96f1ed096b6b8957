// SPDX-License-Identifier: AGPL-3.0-or-later
// Empty: its target carries the precompiled header of all tests.
