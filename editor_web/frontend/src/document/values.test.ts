/** Values in a line. */
import { expect, test } from 'vitest'
import { flowing, inShort, isShort, numeral } from './values'

test('scalars and short rows stand on one line, everything else is unfolded', () => {
  expect([1, 'x', null, true, [], {}, [1, 2.5, 'a']].map(isShort)).toEqual([true, true, true, true, true, true, true])
  expect([{ a: 1 }, [[1]], Array.from({ length: 90 }, () => 1)].map(isShort)).toEqual([false, false, false])
})

test('what is folded tells how much there is', () => {
  expect([{ a: 1 }, { a: 1, b: 2 }, [[1], [2]]].map(inShort)).toEqual(['1 field', '2 fields', '2 items'])
  expect([[1, 0.123456789], '', null, {}].map(inShort)).toEqual(['[1, 0.12346]', '""', 'none', '{}'])
})

test('numbers keep five digits', () => {
  expect([12, 0.1, 1234.56789, 0.00001234, -2.5e9 + 0.5].map(numeral)).toEqual(['12', '0.1', '1234.568', '1.234e-5', '-2.500e+9'])
})

test('text of a source file has no line ends but those of its paragraphs and lists', () => {
  expect(flowing('One line\nand the next.\n\nAnother:\n- a\n  b\n- c')).toBe('One line and the next.\n\nAnother:\n- a b\n- c')
})
