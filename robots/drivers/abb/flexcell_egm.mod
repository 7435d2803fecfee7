MODULE FlexcellEgm
  ! The motion task (T_ROB1) of the driver `abb_irc5` with the option `egm`. It takes the place of ROS_motion.
  ! Never run on hardware. Read docs/how-to/connect-an-abb-irc5.md first.
  !
  ! RobotWare 6 with Externally Guided Motion (689-1). Configure the computer as an UdpUc device:
  ! Communication, Transmission Protocol: name `flexcell`, type UDPUC, its address, port 6510.
  !
  ! The controller sends its axes every 4 ms, and follows the answers. Where none comes for COMM_TIMEOUT seconds,
  ! guided motion ends where the last answer led, and begins again, at rest, without an answer to follow.

  LOCAL CONST num COMM_TIMEOUT := 0.2;
  ! Greatest speed of an axis over the planned one, degrees a second. Begin with little.
  LOCAL CONST num FASTEST := 20;
  ! Longer than a shift: guided motion does not end by itself because the axes stand still.
  LOCAL CONST num STANDS_STILL := 86400;
  LOCAL CONST egm_minmax CLOSE := [-0.01, 0.01];
  LOCAL VAR egmident guide;

  PROC main()
    WHILE TRUE DO
      Follow;
    ENDWHILE
  ENDPROC

  LOCAL PROC Follow()
    EGMReset guide;
    EGMGetId guide;
    EGMSetupUC ROB_1, guide, "default", "flexcell" \Joint \CommTimeout:=COMM_TIMEOUT;
    EGMActJoint guide \J1:=CLOSE \J2:=CLOSE \J3:=CLOSE \J4:=CLOSE \J5:=CLOSE \J6:=CLOSE
      \SampleRate:=4 \MaxSpeedDeviation:=FASTEST;
    EGMRunJoint guide, EGM_STOP_HOLD \J1 \J2 \J3 \J4 \J5 \J6 \CondTime:=STANDS_STILL;
    EGMReset guide;
  ERROR
    IF ERRNO = ERR_UDPUC_COMM THEN
      ! Nobody answers: the arm stands. Wait for a computer that does.
      EGMReset guide;
      RETURN;
    ENDIF
    RAISE;
  ENDPROC
ENDMODULE
