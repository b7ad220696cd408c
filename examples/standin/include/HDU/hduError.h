/* SPDX-License-Identifier: MIT */
#ifndef STANDIN_HDU_ERROR_H
#define STANDIN_HDU_ERROR_H

/* Error helpers of palpate's stand-in device; see HD/hd.h beside it. */

#include <HD/hd.h>

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Writes "message: name (code, internal code)" and a line end. Not for the servo thread. */
void hduPrintError(FILE* stream, const HDErrorInfo* error, const char* message);
/* Warm motors, too much force or speed: forget the contact, go on. */
HDboolean hduIsForceError(const HDErrorInfo* error);
/* Connection, timer or scheduler: stop. */
HDboolean hduIsSchedulerError(const HDErrorInfo* error);

#ifdef __cplusplus
}
#endif

#endif
