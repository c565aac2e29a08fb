/** A text that depends on its {count}, by the plural forms that its language has. */
export type Forms = Partial<Record<Intl.LDMLPluralRule, string>> & { other: string };
