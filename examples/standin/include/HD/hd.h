/* SPDX-License-Identifier: MIT */
#ifndef STANDIN_HD_H
#define STANDIN_HD_H

/* Declarations of palpate's stand-in haptic device: the part of a device interface that
 * examples/openhaptics.hpp calls, under the names and values of OpenHaptics HDAPI, so that the same source
 * builds where the vendor's kit is not installed. Written from the documented interface. Private to the
 * examples: never installed, and not for use with hardware. standin.hpp describes the behaviour. */

#include <limits.h>

#ifdef __cplusplus
extern "C" {
#endif

/* HDAPI: linkage. HDAPIENTRY, HDCALLBACK: calling conventions, which the stand-in leaves at the default. */
#define HDAPI
#define HDAPIENTRY
#define HDCALLBACK

typedef double HDdouble;
typedef float HDfloat;
typedef int HDint;
typedef long HDlong;
typedef unsigned long HDulong;
typedef unsigned short HDushort;
typedef unsigned char HDboolean;
typedef const char* HDstring;

typedef unsigned int HHD; /* a device */
typedef unsigned int HDenum;
typedef unsigned int HDerror;
typedef unsigned int HDCallbackCode;
typedef unsigned int HDWaitCode;
typedef unsigned long HDSchedulerHandle;
typedef HDCallbackCode(HDCALLBACK* HDSchedulerCallback)(void* pUserData);

typedef struct {
  HDerror errorCode;     /* one of the codes below */
  int internalErrorCode; /* the driver's own code, for its support desk */
  HHD hHD;               /* the device that was current */
} HDErrorInfo;

#define HD_TRUE 1
#define HD_FALSE 0
#define HD_DEFAULT_DEVICE NULL /* include <cstddef> first */
#define HD_INVALID_HANDLE 0xFFFFFFFF
#define HD_DEVICE_ERROR(X) (((X).errorCode) != HD_SUCCESS)

/* Error codes: wrong calls */
#define HD_SUCCESS 0x0000
#define HD_INVALID_ENUM 0x0100
#define HD_INVALID_VALUE 0x0101
#define HD_INVALID_OPERATION 0x0102
#define HD_INVALID_INPUT_TYPE 0x0103
#define HD_BAD_HANDLE 0x0104
/* ... forces: the amplifiers have dropped out */
#define HD_WARM_MOTORS 0x0200
#define HD_EXCEEDED_MAX_FORCE 0x0201
#define HD_EXCEEDED_MAX_FORCE_IMPULSE 0x0202
#define HD_EXCEEDED_MAX_VELOCITY 0x0203
#define HD_FORCE_ERROR 0x0204
/* ... the device and its connection */
#define HD_DEVICE_FAULT 0x0300
#define HD_DEVICE_ALREADY_INITIATED 0x0301
#define HD_COMM_ERROR 0x0302
#define HD_COMM_CONFIG_ERROR 0x0303
#define HD_TIMER_ERROR 0x0304
/* ... frames and the scheduler */
#define HD_ILLEGAL_BEGIN 0x0400
#define HD_ILLEGAL_END 0x0401
#define HD_FRAME_ERROR 0x0402
#define HD_INVALID_PRIORITY 0x0500
#define HD_SCHEDULER_FULL 0x0501

/* State; lengths in mm, velocities in mm/s, angles in rad */
#define HD_CURRENT_BUTTONS 0x2000        /* int, bit mask */
#define HD_CURRENT_SAFETY_SWITCH 0x2001  /* boolean */
#define HD_CURRENT_INKWELL_SWITCH 0x2002 /* boolean, 0 when docked */
#define HD_CURRENT_POSITION 0x2050       /* 3 */
#define HD_CURRENT_VELOCITY 0x2051       /* 3, smoothed */
#define HD_CURRENT_TRANSFORM 0x2052      /* 16, column-major, translation in 12..14 */
#define HD_LAST_POSITION 0x2250          /* of the frame before */
#define HD_LAST_VELOCITY 0x2251
#define HD_LAST_TRANSFORM 0x2252

/* Identity: strings */
#define HD_VERSION 0x2500
#define HD_DEVICE_MODEL_TYPE 0x2501
#define HD_DEVICE_DRIVER_VERSION 0x2502
#define HD_DEVICE_VENDOR 0x2503
#define HD_DEVICE_SERIAL_NUMBER 0x2504

/* What the device can do */
#define HD_MAX_WORKSPACE_DIMENSIONS 0x2550     /* 6: minimum xyz, maximum xyz [mm] */
#define HD_USABLE_WORKSPACE_DIMENSIONS 0x2551  /* 6 */
#define HD_INPUT_DOF 0x2553                    /* int */
#define HD_OUTPUT_DOF 0x2554                   /* int */
#define HD_CALIBRATION_STYLE 0x2555            /* int, bit mask of the styles below */
#define HD_UPDATE_RATE 0x2600                  /* Hz */
#define HD_INSTANTANEOUS_UPDATE_RATE 0x2601    /* Hz */
#define HD_NOMINAL_MAX_STIFFNESS 0x2602        /* N/mm */
#define HD_NOMINAL_MAX_DAMPING 0x2609          /* N s/mm */
#define HD_NOMINAL_MAX_FORCE 0x2603            /* N, motors cool */
#define HD_NOMINAL_MAX_CONTINUOUS_FORCE 0x2604 /* N */
#define HD_MOTOR_TEMPERATURE 0x2605            /* 3, 0 cold to 1 hot */
#define HD_SOFTWARE_VELOCITY_LIMIT 0x2606      /* mm/s; also a capability */
#define HD_SOFTWARE_FORCE_IMPULSE_LIMIT 0x2607 /* N/ms; also a capability */
#define HD_FORCE_RAMPING_RATE 0x2608           /* N/s */

/* Output */
#define HD_CURRENT_FORCE 0x2700  /* 3, N */
#define HD_CURRENT_TORQUE 0x2701 /* 3, mN m */
#define HD_LAST_FORCE 0x2800
#define HD_LAST_TORQUE 0x2801

/* Capabilities, for hdEnable and hdDisable */
#define HD_FORCE_OUTPUT 0x4000
#define HD_MAX_FORCE_CLAMPING 0x4001
#define HD_FORCE_RAMPING 0x4002
#define HD_SOFTWARE_FORCE_LIMIT 0x4003
#define HD_ONE_FRAME_LIMIT 0x4004

/* Scheduler */
#define HD_CALLBACK_DONE 0
#define HD_CALLBACK_CONTINUE 1
#define HD_WAIT_CHECK_STATUS 0
#define HD_WAIT_INFINITE 1
#define HD_MAX_SCHEDULER_PRIORITY USHRT_MAX
#define HD_MIN_SCHEDULER_PRIORITY 0
#define HD_DEFAULT_SCHEDULER_PRIORITY ((HD_MAX_SCHEDULER_PRIORITY + HD_MIN_SCHEDULER_PRIORITY) / 2)

/* Calibration */
#define HD_CALIBRATION_OK 0x5000
#define HD_CALIBRATION_NEEDS_UPDATE 0x5001
#define HD_CALIBRATION_NEEDS_MANUAL_INPUT 0x5002
#define HD_CALIBRATION_ENCODER_RESET (1 << 0)
#define HD_CALIBRATION_AUTO (1 << 1)
#define HD_CALIBRATION_INKWELL (1 << 2)

HDAPI HHD HDAPIENTRY hdInitDevice(HDstring pConfigName);
HDAPI void HDAPIENTRY hdDisableDevice(HHD hHD);
HDAPI void HDAPIENTRY hdMakeCurrentDevice(HHD hHD);
HDAPI HHD HDAPIENTRY hdGetCurrentDevice(void);

HDAPI void HDAPIENTRY hdBeginFrame(HHD hHD);
HDAPI void HDAPIENTRY hdEndFrame(HHD hHD);

HDAPI HDErrorInfo HDAPIENTRY hdGetError(void);
HDAPI HDstring HDAPIENTRY hdGetErrorString(HDerror errorCode);

HDAPI void HDAPIENTRY hdEnable(HDenum cap);
HDAPI void HDAPIENTRY hdDisable(HDenum cap);
HDAPI HDboolean HDAPIENTRY hdIsEnabled(HDenum cap);

HDAPI void HDAPIENTRY hdGetBooleanv(HDenum pname, HDboolean* params);
HDAPI void HDAPIENTRY hdGetIntegerv(HDenum pname, HDint* params);
HDAPI void HDAPIENTRY hdGetFloatv(HDenum pname, HDfloat* params);
HDAPI void HDAPIENTRY hdGetDoublev(HDenum pname, HDdouble* params);
HDAPI HDstring HDAPIENTRY hdGetString(HDenum pname);
HDAPI void HDAPIENTRY hdSetFloatv(HDenum pname, const HDfloat* params);
HDAPI void HDAPIENTRY hdSetDoublev(HDenum pname, const HDdouble* params);

HDAPI HDenum HDAPIENTRY hdCheckCalibration(void);
HDAPI void HDAPIENTRY hdUpdateCalibration(HDenum style);

HDAPI void HDAPIENTRY hdStartScheduler(void);
HDAPI void HDAPIENTRY hdStopScheduler(void);
HDAPI void HDAPIENTRY hdSetSchedulerRate(HDulong nRate);
HDAPI void HDAPIENTRY hdScheduleSynchronous(HDSchedulerCallback pCallback, void* pUserData,
                                            HDushort nPriority);
HDAPI HDSchedulerHandle HDAPIENTRY hdScheduleAsynchronous(HDSchedulerCallback pCallback, void* pUserData,
                                                          HDushort nPriority);
HDAPI void HDAPIENTRY hdUnschedule(HDSchedulerHandle hHandle);
HDAPI HDboolean HDAPIENTRY hdWaitForCompletion(HDSchedulerHandle hHandle, HDWaitCode param);
HDAPI HDdouble HDAPIENTRY hdGetSchedulerTimeStamp(void);

#ifdef __cplusplus
}
#endif

#endif
