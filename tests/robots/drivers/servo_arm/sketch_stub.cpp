// What the sketch needs of an Arduino, on a machine with a clock that the test sets. Reads from stdin one request a line:
// "t 20" lets 20 ms pass, "l TEXT" sends a line; after each it prints what the sketch said, and "." at the end.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

typedef unsigned char byte;
static unsigned long now_ms = 0;
unsigned long millis() { return now_ms; }
static std::string incoming;

struct SerialStub {
  void begin(unsigned long) {}
  int available() { return (int)incoming.size(); }
  int read() {
    char first = incoming[0];
    incoming.erase(0, 1);
    return first;
  }
  void print(const char *text) { std::cout << text; }
  void print(char text) { std::cout << text; }
  void print(double value, int digits) { printf("%.*f", digits, value), fflush(stdout); }
} Serial;

#include SKETCH

int main() {
  std::cout << std::unitbuf;
  setup();
  std::string request;
  while (std::getline(std::cin, request)) {
    if (request[0] == 't') {
      for (long left = atol(request.c_str() + 2); left > 0; left--) now_ms++, loop();
    } else {
      incoming += request.substr(2) + "\n";
      loop();
    }
    std::cout << ".\n";
  }
}
