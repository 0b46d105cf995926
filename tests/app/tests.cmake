# SPDX-License-Identifier: GPL-3.0-or-later
taut_add_test(app monitor LABELS unit LIBS taut::app fmt::fmt)
