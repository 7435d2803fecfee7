/** Colours of the page for canvases. */
import { expect, it } from 'vitest'
import { tokensOf } from './tokens'

function shown(scheme: string): (name: string) => string {
  const element = document.createElement('div')
  element.style.colorScheme = scheme
  element.style.setProperty('--both', 'light-dark(rgb(30 50 90 / 2.6%),#e8eaef)')
  element.style.setProperty('--same', '#c01d1d')
  document.body.append(element)
  return tokensOf(element)
}

it('gives the colour of the scheme that is shown', () => {
  expect(shown('light')('both')).toBe('rgb(30 50 90 / 2.6%)')
  expect(shown('dark')('both')).toBe('#e8eaef')
})

it('gives a colour that is the same in both schemes', () => {
  expect(shown('dark')('same')).toBe('#c01d1d')
})

it('gives that of the light scheme before a scheme is known', () => {
  expect(shown('normal')('both')).toBe('rgb(30 50 90 / 2.6%)')
})
