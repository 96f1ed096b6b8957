# SPDX-License-Identifier: AGPL-3.0-or-later
# Its headers come with Sofa.Component.Haptics.
add_library(Sofa.Simulation.Core INTERFACE)
