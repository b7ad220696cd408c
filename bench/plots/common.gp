# SPDX-License-Identifier: MIT
set datafile separator ","
set grid back lc rgb "#dddddd"
set border lc rgb "#666666"
ours = "#d62728"
theirs = "#1f77b4"
