# SPDX-License-Identifier: MIT
name = "work_precision_force"
columns = 2
unit = "ns"
headline = "Parts of the force path, run time against error: down and to the left is better"
set format y "10^{%T}"
set ylabel "relative error"
panel = 800
load here."/work_precision.gp"
