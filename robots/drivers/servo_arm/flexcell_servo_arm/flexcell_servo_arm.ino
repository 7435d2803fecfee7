// Servo arm of flexcell: lines of text on the serial port, see docs/how-to/connect-a-servo-arm.md.
//
//   "45.0 120.0"   set point: angle of each servo in degrees       -> OK 45.0 118.2 place (written so far)
//   "?"            asks                                             -> OK ... or HALT why ...
//   "GO"           accepts set points; after a start it holds the   -> OK ...
//                  servos at HOME_DEG: put the arm there by hand first
//   "STOP"         holds the servos where they are                  -> HALT stop ...
//   "pick" "place" closes, opens the claw                           -> OK ...
//
// After a start it says READY and moves nothing before GO. It turns no servo faster than MAX_DEG_S. Without a line for
// WATCHDOG_MS, or without a set point for so long while a joint turns, it holds the servos where they are and takes no set
// points before the next GO. Neither is a safety function.

#include <Servo.h>

const unsigned long BAUD = 115200;
const byte SERVOS = 2;
const byte PINS[SERVOS] = {9, 10};
const float LOWER_DEG[SERVOS] = {0.0, 0.0};
const float UPPER_DEG[SERVOS] = {180.0, 180.0};
const float HOME_DEG[SERVOS] = {0.0, 160.0};
const byte CLAW_PIN = 11;
const float CLAW_OPEN_DEG = 90.0;
const float CLAW_CLOSED_DEG = 45.0;
// Start low, and raise it when the arm moves as it should.
const float MAX_DEG_S = 60.0;
const unsigned long WATCHDOG_MS = 500;
const unsigned long STEP_MS = 5;
const byte LONGEST_LINE = 63;
// Pulses of 0 and 180 degrees; measure yours.
const float PULSE_0_US = 544.0;
const float PULSE_180_US = 2400.0;

Servo servos[SERVOS + 1];  // the last is the claw
float written[SERVOS + 1];
float target[SERVOS + 1];
bool attached = false;
bool closes = false;
const char *halt = "boot";
unsigned long lastLine = 0;
unsigned long lastSetPoint = 0;
unsigned long lastStep = 0;
char line[LONGEST_LINE + 1];
byte length = 0;
bool tooLong = false;

void writeServo(byte index) {
  servos[index].writeMicroseconds((int)(PULSE_0_US + written[index] * (PULSE_180_US - PULSE_0_US) / 180.0 + 0.5));
}

void holdHere() {
  for (byte index = 0; index <= SERVOS; index++) target[index] = written[index];
}

void report() {
  if (halt) {
    Serial.print("HALT ");
    Serial.print(halt);
  } else {
    Serial.print("OK");
  }
  for (byte index = 0; index < SERVOS; index++) {
    Serial.print(' ');
    Serial.print(written[index], 1);
  }
  Serial.print(closes ? " pick\n" : " place\n");
}

void refuse(const char *why) {
  Serial.print("ERR ");
  Serial.print(why);
  Serial.print('\n');
}

void go() {
  if (!attached) {
    for (byte index = 0; index <= SERVOS; index++) {
      servos[index].attach(index < SERVOS ? PINS[index] : CLAW_PIN);
      writeServo(index);
    }
    attached = true;
  }
  holdHere();
  halt = 0;
  lastSetPoint = millis();
  report();
}

void setPoint(char *text) {
  float angles[SERVOS];
  for (byte index = 0; index < SERVOS; index++) {
    char *end = text;
    angles[index] = strtod(text, &end);
    if (end == text || (*end != ' ' && *end != 0)) return refuse("not understood");
    text = end;
    while (*text == ' ') text++;
  }
  if (*text) return refuse("not understood");
  for (byte index = 0; index < SERVOS; index++) {
    // Written so that NaN is refused too.
    if (!(angles[index] >= LOWER_DEG[index] && angles[index] <= UPPER_DEG[index])) return refuse("out of range");
  }
  if (!halt) {
    for (byte index = 0; index < SERVOS; index++) target[index] = angles[index];
    lastSetPoint = millis();
  }
  report();
}

void execute() {
  if (strcmp(line, "?") == 0) {
    report();
  } else if (strcmp(line, "GO") == 0) {
    go();
  } else if (strcmp(line, "STOP") == 0) {
    holdHere();
    if (!halt) halt = "stop";
    report();
  } else if (strcmp(line, "pick") == 0 || strcmp(line, "place") == 0) {
    if (!halt) {
      closes = line[1] == 'i';
      target[SERVOS] = closes ? CLAW_CLOSED_DEG : CLAW_OPEN_DEG;
    }
    report();
  } else {
    setPoint(line);
  }
}

void receive() {
  while (Serial.available()) {
    char received = Serial.read();
    if (received == '\r') continue;
    if (received != '\n') {
      if (length < LONGEST_LINE) line[length++] = received;
      else tooLong = true;
      continue;
    }
    line[length] = 0;
    lastLine = millis();
    if (tooLong) refuse("not understood");
    else execute();
    length = 0;
    tooLong = false;
  }
}

bool jointTurns() {
  for (byte index = 0; index < SERVOS; index++) {
    if (target[index] != written[index]) return true;
  }
  return false;
}

void step(float seconds) {
  for (byte index = 0; index <= SERVOS; index++) {
    float most = MAX_DEG_S * seconds, distance = target[index] - written[index];
    if (distance == 0.0) continue;
    written[index] = fabs(distance) <= most ? target[index] : written[index] + (distance > 0.0 ? most : -most);
    if (attached) writeServo(index);
  }
}

void setup() {
  for (byte index = 0; index < SERVOS; index++) written[index] = HOME_DEG[index];
  written[SERVOS] = CLAW_OPEN_DEG;
  holdHere();
  Serial.begin(BAUD);
  lastStep = lastLine = millis();
  Serial.print("READY flexcell_servo_arm 1\n");
}

void loop() {
  unsigned long now = millis();
  if (!halt && (now - lastLine > WATCHDOG_MS || (jointTurns() && now - lastSetPoint > WATCHDOG_MS))) {
    holdHere();
    halt = "watchdog";
  }
  if (now - lastStep >= STEP_MS) {
    step((now - lastStep) / 1000.0);
    lastStep = now;
  }
  receive();
}
