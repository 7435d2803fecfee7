/** The icon of a node: hidden from screen readers where its word stands beside, and said where it does not. */
import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { show } from '../../testing/page'
import { KindIcon } from './KindIcon'

function drawn(icon: string): string {
  return document.querySelector(`[data-icon="${icon}"]`)?.innerHTML ?? ''
}

it('is silent beside its word, and has a title without', () => {
  show(
    <>
      <KindIcon icon="sitemap" />
      <KindIcon icon="gripper" title="gripper.Grasp" />
    </>,
  )
  expect(screen.getAllByRole('img')).toEqual([screen.getByRole('img', { name: 'gripper.Grasp' })])
})

it('draws a name that it does not know as a state', () => {
  show(['state', 'welding', 'constructor', 'gripper'].map((icon) => <KindIcon key={icon} icon={icon} />))
  expect(drawn('state')).not.toBe('')
  expect(drawn('welding')).toBe(drawn('state'))
  expect(drawn('constructor')).toBe(drawn('state'))
  expect(drawn('gripper')).not.toBe(drawn('state'))
})
