/** The list of keys: all commands, found by words, changed by pressing, conflicts named, and set back. */
import { screen, within } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, show } from '../../../testing/page'
import { keyOf, showKeys, useKeyMap } from '../../api/keyMap'
import { COMMAND_TABLE } from '../../document/commandTable'
import { KeySheet } from './KeySheet'

function opened() {
  live()
  showKeys()
  return show(<KeySheet />)
}

function row(id: string): HTMLElement {
  const found = document.querySelector<HTMLElement>(`[data-key-of="${id}"]`)
  if (!found) throw new Error(`there is no row ${id}`)
  return found
}

it('lists every command with its keys, and finds them by words and by keys', async () => {
  const user = opened()
  expect(screen.getAllByRole('term')).toHaveLength(COMMAND_TABLE.length)
  expect(row('redo')).toHaveTextContent('Ctrl+Shift+ZCtrl+YRedo')
  expect(row('svg')).toHaveTextContent('none')
  await user.type(screen.getByLabelText('Find a command or a key'), 'step')
  expect(screen.getAllByRole('term').map((each) => each.textContent)).toEqual(['I', 'O', 'U', 'Z'])
  await user.clear(screen.getByLabelText('Find a command or a key'))
  await user.type(screen.getByLabelText('Find a command or a key'), 'Ctrl+G')
  expect(row('group')).toBeVisible()
})

it('gives a command the key that is pressed, keeps it, and sets it back', async () => {
  const user = opened()
  await user.click(screen.getByRole('button', { name: 'Change the key: Save' }))
  await user.keyboard('{Control>}{Shift>}S{/Shift}{/Control}')
  expect(row('save')).toHaveTextContent('Ctrl+Shift+SSave')
  expect(keyOf('save')).toBe('Ctrl+Shift+S')
  expect(localStorage.getItem('flexcell.keys')).toContain('"save"')
  await user.click(screen.getByRole('button', { name: 'Reset: Save' }))
  expect(keyOf('save')).toBe('Ctrl+S')
})

it('names the command that has the key, and takes it from there only when asked', async () => {
  const user = opened()
  await user.click(screen.getByRole('button', { name: 'Change the key: Pause, or resume a paused run' }))
  await user.keyboard('i')
  expect(screen.getByText('It is the key of “Step into the next node”.')).toBeVisible()
  expect([keyOf('pause'), keyOf('into')]).toEqual(['P', 'I'])
  await user.click(screen.getByRole('button', { name: 'Use it here' }))
  expect([keyOf('pause'), keyOf('into')]).toEqual(['I', undefined])
  await user.click(screen.getByRole('button', { name: 'Reset all' }))
  expect([keyOf('pause'), keyOf('into')]).toEqual(['P', 'I'])
})

it('refuses the key that stops the cell; Escape changes nothing, and a command may have no key', async () => {
  const user = opened()
  await user.click(screen.getByRole('button', { name: 'Change the key: Save' }))
  await user.keyboard('{Control>}{Shift>}{Backspace}{/Shift}{/Control}')
  expect(screen.getByText('this key stops the cell, on every page')).toBeVisible()
  await user.keyboard('{Escape}')
  expect(keyOf('save')).toBe('Ctrl+S')
  expect(screen.getByRole('dialog', { name: 'Keyboard' })).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Change the key: Save' }))
  await user.click(screen.getByRole('button', { name: 'No key' }))
  expect(keyOf('save')).toBeUndefined()
})

it('switches characters off and closes', async () => {
  const user = opened()
  await user.click(screen.getByLabelText('Single keys are commands'))
  expect(useKeyMap.getState().areSingleOn).toBe(false)
  await user.click(within(screen.getByRole('dialog')).getByRole('button', { name: 'Close' }))
  expect(screen.queryByRole('dialog')).toBeNull()
})
