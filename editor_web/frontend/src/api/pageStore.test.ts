/** Stores that begin anew with the page. */
import { expect, it } from 'vitest'
import { beginPage, pageStore } from './pageStore'

it('begins anew with what is made anew, after what it held was closed', () => {
  const closed: number[] = []
  let made = 0
  const store = pageStore(
    () => ({ of: (made += 1), words: [] as string[] }),
    ({ of }) => closed.push(of),
  )
  store.getState().words.push('kept')
  store.setState({ of: 7 })
  beginPage()
  expect(closed).toEqual([7])
  expect(store.getState()).toEqual({ of: 2, words: [] })
})
