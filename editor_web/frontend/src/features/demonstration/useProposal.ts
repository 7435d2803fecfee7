/** Asks for the proposal of the steps as they are, a moment after the last change; the newest answer counts. */
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { propose } from '../../api/demonstration'
import type { DemonstrationBody, ProposalBody } from '../../api/types'

const PAUSE_MS = 150

export interface Proposed {
  readonly proposal?: ProposalBody
  readonly problem?: string
}

export function useProposal(body: DemonstrationBody | undefined): Proposed {
  const [found, setFound] = useState<Proposed>({})
  const asked = body && JSON.stringify(body)
  useEffect(() => {
    let isCurrent = true
    const timer = setTimeout(() => {
      if (asked === undefined) {
        setFound({})
        return
      }
      propose(JSON.parse(asked) as DemonstrationBody).then(
        (proposal) => isCurrent && setFound({ proposal }),
        (error: unknown) => isCurrent && setFound({ problem: wordsOf(error) }),
      )
    }, PAUSE_MS)
    return () => {
      isCurrent = false
      clearTimeout(timer)
    }
  }, [asked])
  return found
}
