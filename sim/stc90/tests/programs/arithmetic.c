/* Arithmetic of all widths on numbers at which it goes wrong. The results lie in the upper half of external memory. */
#include <8052.h>

#define COUNT 9

static __code const long numbers[COUNT] = {0, 1, -1, 7, 255, -256, 32767, -32768, 123456789};
__xdata __at(0x0200) unsigned long results[100];
static unsigned char next;

static void keep(unsigned long value)
{
    results[next++] = value;
}

static void bytes(signed char a, signed char b)
{
    keep((unsigned char)(a * b));
    keep((int)a * b);
    keep(a << (b & 7));
    keep((unsigned char)a >> (b & 7));
    if (b != 0)
        keep((a / b) ^ ((int)(a % b) << 8));
}

static void words(int a, int b)
{
    keep((long)a * b);
    keep((unsigned)a - (unsigned)b);
    if (b != 0)
        keep(((unsigned)a / (unsigned)b) | ((unsigned long)((unsigned)a % (unsigned)b) << 16));
}

static void longs(long a, long b)
{
    keep(a * b);
    if (b != 0)
        keep((a / b) ^ (a % b));
}

static void floats(long a, long b)
{
    float x = (float)a / 3.0f, y = (float)b * 0.001f;

    keep((unsigned long)(long)(x * y + 1.5f));
}

void main(void)
{
    unsigned char a, b;

    for (a = 0; a < COUNT; a++) {
        b = (unsigned char)(a * 5 + 2) % COUNT;
        bytes((signed char)numbers[a], (signed char)numbers[b]);
        words((int)numbers[a], (int)numbers[b]);
        longs(numbers[a], numbers[b]);
        floats(numbers[a] % 1000, numbers[b] % 1000);
    }
    for (;;)
        ;
}
